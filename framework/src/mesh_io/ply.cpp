// Polygon File Format (Stanford): text and binary of both byte orders, any elements and properties in any order. Of
// these "vertex" (x, y, z) and "face" (the list vertex_indices or vertex_index) are used and the others passed over.
#include "mesh_io/ply_header.h"
#include "mesh_io/polygon.h"
#include "mesh_io/scanner.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace kolize::mesh_io {

namespace {

constexpr std::array<std::size_t, 8> scalar_size = {1, 1, 2, 2, 4, 4, 4, 8};  // by PlyScalar

// Values of a text body, each at least a digit and a blank.
class TextValues {
public:
    TextValues(const MeshFile& file, const PlyHeader& header)
        : in_(file, header.body, Layout::free_form, header.body_line) {}

    double next(PlyScalar) { return in_.number("a value"); }
    std::size_t remaining() const { return in_.remaining() + 1; }
    static std::size_t smallest(PlyScalar) { return 2; }
    void end_row(TriangleSoup& soup) const { soup.lines.resize(soup.triangles.size(), in_.line()); }
    [[noreturn]] void fail(const std::string& message) const { in_.fail(message); }

private:
    Scanner in_;
};

class BinaryValues {
public:
    BinaryValues(const MeshFile& file, const PlyHeader& header)
        : file_(file),
          at_(file.bytes.size() - header.body.size()),
          reverse_((header.encoding == PlyEncoding::big_endian) == (std::endian::native == std::endian::little)) {}

    double next(PlyScalar type) {
        switch (type) {
        case PlyScalar::int8: return take<std::int8_t>();
        case PlyScalar::uint8: return take<std::uint8_t>();
        case PlyScalar::int16: return take<std::int16_t>();
        case PlyScalar::uint16: return take<std::uint16_t>();
        case PlyScalar::int32: return take<std::int32_t>();
        case PlyScalar::uint32: return take<std::uint32_t>();
        case PlyScalar::float32: return take<float>();
        case PlyScalar::float64: return take<double>();
        }
        return 0;
    }
    std::size_t remaining() const { return file_.bytes.size() - at_; }
    static std::size_t smallest(PlyScalar type) { return scalar_size[static_cast<std::size_t>(type)]; }
    void end_row(TriangleSoup&) const {}
    [[noreturn]] void fail(const std::string& message) const { fail_at_byte(file_, at_, message); }

private:
    template <class T>
    T take() {
        if (remaining() < sizeof(T)) fail("the file ends within a row");
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), &file_.bytes[at_], sizeof(T));
        if (reverse_) std::reverse(bytes.begin(), bytes.end());
        at_ += sizeof(T);
        return std::bit_cast<T>(bytes);
    }

    const MeshFile& file_;
    std::size_t at_;
    bool reverse_;
};

template <class Values>
class BodyReader {
public:
    BodyReader(const MeshFile& file, const PlyHeader& header) : file_(file), header_(header), values_(file, header) {}

    TriangleSoup run() {
        soup_.file = file_.name;
        for (const PlyElement& element : header_.elements)
            if (element.name == "vertex") count_vertices(element);
        for (const PlyElement& element : header_.elements) read_element_rows(element);
        return std::move(soup_);
    }

private:
    // Faces may come before the vertices that they name.
    void count_vertices(const PlyElement& element) {
        for (const char* axis : {"x", "y", "z"}) element.require_property(file_, axis, false);
        require_room(element);
        vertex_count_ += element.count;
    }

    void read_element_rows(const PlyElement& element) {
        require_room(element);
        if (element.name == "vertex") return read_vertices(element);
        if (element.name == "face") return read_faces(element);
        if (element.properties.empty()) return;
        for (std::uint64_t row = 0; row < element.count; ++row)
            for (const PlyProperty& property : element.properties) read(property);
    }

    void require_room(const PlyElement& element) const {
        std::size_t row_size = 0;
        for (const PlyProperty& p : element.properties) row_size += values_.smallest(p.count.value_or(p.type));
        if (row_size == 0 || element.count <= values_.remaining() / row_size) return;
        throw Error(SourceLocation{file_.name, element.line},
                    "element " + quoted(element.name) + " is to have " + std::to_string(element.count) +
                        " rows, but only " + std::to_string(values_.remaining()) + " bytes follow");
    }

    void read_vertices(const PlyElement& element) {
        const std::size_t column[3] = {element.require_property(file_, "x", false),
                                       element.require_property(file_, "y", false),
                                       element.require_property(file_, "z", false)};
        soup_.vertices.reserve(soup_.vertices.size() + element.count);
        for (std::uint64_t row = 0; row < element.count; ++row) {
            Vec3 p;
            for (std::size_t i = 0; i < element.properties.size(); ++i) {
                read(element.properties[i]);
                for (int axis = 0; axis < 3; ++axis)
                    if (column[axis] == i) p[axis] = list_[0];
            }
            if (!p.allFinite()) values_.fail("a coordinate is not finite");
            soup_.vertices.push_back(p);
        }
    }

    void read_faces(const PlyElement& element) {
        bool singular = false;
        for (const PlyProperty& property : element.properties) singular |= property.name == "vertex_index";
        const std::size_t column = element.require_property(file_, singular ? "vertex_index" : "vertex_indices", true);
        for (std::uint64_t row = 0; row < element.count; ++row)
            for (std::size_t i = 0; i < element.properties.size(); ++i) {
                read(element.properties[i]);
                if (i == column) add_face();
            }
    }

    void add_face() {
        if (list_.size() < 3) values_.fail("a face needs at least 3 corners, has " + std::to_string(list_.size()));
        corners_.clear();
        for (const double v : list_) {
            if (!(v >= 0 && v < static_cast<double>(vertex_count_) && v == std::floor(v)))
                values_.fail("a face names vertex " + shortest_text(v) + ", but the file has " +
                             std::to_string(vertex_count_) + ", counted from 0");
            corners_.push_back(static_cast<std::uint32_t>(v));
        }
        add_polygon(soup_.triangles, soup_.vertices, corners_);
        values_.end_row(soup_);
    }

    // One property of a row into list_; a number is a list of one.
    void read(const PlyProperty& property) {
        std::size_t count = 1;
        if (property.count) {
            const double length = values_.next(*property.count);
            if (!(length >= 0 && length == std::floor(length))) values_.fail("the length of a list must be a count");
            if (length > static_cast<double>(values_.remaining() / values_.smallest(property.type)))
                values_.fail("a list goes on past the end of the file");
            count = static_cast<std::size_t>(length);
        }
        list_.resize(count);
        for (double& value : list_) value = values_.next(property.type);
    }

    const MeshFile& file_;
    const PlyHeader& header_;
    Values values_;
    TriangleSoup soup_;
    std::uint64_t vertex_count_ = 0;
    std::vector<double> list_;
    std::vector<std::uint32_t> corners_;
};

}  // namespace

TriangleSoup read_ply(const MeshFile& file) {
    const PlyHeader header = read_ply_header(file);
    if (header.encoding == PlyEncoding::text) return BodyReader<TextValues>(file, header).run();
    return BodyReader<BinaryValues>(file, header).run();
}

}  // namespace kolize::mesh_io
