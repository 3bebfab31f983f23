// Writes test solids in every mesh format, and mesh files of any content.
#pragma once

#include <kolize/mesh.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <unistd.h>

namespace kolize::test {

// A folder that goes when the test is over.
class ScratchFolder {
public:
    ScratchFolder() {
        static int made = 0;
        const std::string name = "kolize-mesh-" + std::to_string(getpid()) + "-" + std::to_string(made++);
        path_ = std::filesystem::temp_directory_path() / name;
        std::filesystem::create_directories(path_);
    }
    ~ScratchFolder() { std::filesystem::remove_all(path_); }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path_ / name, std::ios::binary) << bytes;
        return path_ / name;
    }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

inline std::string file_bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

template <class T>
void put(std::string& bytes, T value, bool big_endian = false) {
    char raw[sizeof(T)];
    std::copy_n(reinterpret_cast<const char*>(&value), sizeof(T), raw);
    if (big_endian != (std::endian::native == std::endian::big)) std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
}

inline std::string words(const Vec3& p) {
    std::ostringstream out;
    out.precision(17);
    out << p.x() << ' ' << p.y() << ' ' << p.z();
    return out.str();
}

inline std::string as_off(const TriangleSoup& soup) {
    std::ostringstream out;
    out << "OFF\n" << soup.vertices.size() << ' ' << soup.triangles.size() << " 0\n";
    for (const Vec3& v : soup.vertices) out << words(v) << '\n';
    for (const Triangle& t : soup.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
    return out.str();
}

inline std::string as_text_stl(const TriangleSoup& soup) {
    std::string text = "solid test\n";
    for (const Triangle& t : soup.triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const std::uint32_t v : t) text += "vertex " + words(soup.vertices[v]) + '\n';
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid test\n";
}

inline std::string as_binary_stl(const TriangleSoup& soup) {
    std::string bytes = "solid in name only";
    bytes.resize(80, ' ');
    put(bytes, static_cast<std::uint32_t>(soup.triangles.size()));
    for (const Triangle& t : soup.triangles) {
        for (int i = 0; i < 3; ++i) put(bytes, 0.0f);
        for (const std::uint32_t v : t)
            for (const double x : soup.vertices[v]) put(bytes, static_cast<float>(x));
        put(bytes, std::uint16_t{7});
    }
    return bytes;
}

inline std::string ply_header(const TriangleSoup& soup, const std::string& format, const std::string& type) {
    std::string text = "ply\nformat " + format + " 1.0\ncomment by a test \\\n";
    text += "element vertex " + std::to_string(soup.vertices.size()) + '\n';
    for (const char* axis : {"x", "y", "z"}) text += "property " + type + ' ' + axis + '\n';
    text += "property uchar shade\nelement face " + std::to_string(soup.triangles.size());
    return text + "\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string as_text_ply(const TriangleSoup& soup) {
    std::ostringstream out;
    for (const Vec3& v : soup.vertices) out << words(v) << " 255\n";
    for (const Triangle& t : soup.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
    return ply_header(soup, "ascii", "double") + out.str();
}

inline std::string as_binary_ply(const TriangleSoup& soup, bool big_endian) {
    std::string bytes = ply_header(soup, big_endian ? "binary_big_endian" : "binary_little_endian", "double");
    for (const Vec3& v : soup.vertices) {
        for (const double x : v) put(bytes, x, big_endian);
        put(bytes, std::uint8_t{255});
    }
    for (const Triangle& t : soup.triangles) {
        put(bytes, std::uint8_t{3});
        for (const std::uint32_t v : t) put(bytes, static_cast<std::int32_t>(v), big_endian);
    }
    return bytes;
}

}  // namespace kolize::test
