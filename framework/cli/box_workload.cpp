#include "box_workload.h"

#include "csv_row.h"

#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>

namespace kolize::cli {
namespace {

constexpr const char* csv_header = "frame,min_x,min_y,min_z,max_x,max_y,max_z";

// Throws std::invalid_argument that says what is wrong.
Aabb checked(const Aabb& box) {
    if (!box.finite()) throw std::invalid_argument("a coordinate is not finite");
    if ((box.min.array() > box.max.array()).any()) throw std::invalid_argument("the box has min > max");
    return box;
}

Aabb box_from(const double* numbers) {
    return checked({Vec3(numbers[0], numbers[1], numbers[2]), Vec3(numbers[3], numbers[4], numbers[5])});
}

// --- CSV -----------------------------------------------------------------------------------------------------------

// Frame number and box of one row. Throws std::invalid_argument.
std::pair<std::uint64_t, Aabb> parse_box(std::string_view line) {
    std::array<double, 7> numbers{};
    parse_row(line, csv_header, numbers);
    if (!(numbers[0] >= 0 && numbers[0] <= 1e15) || numbers[0] != std::floor(numbers[0]))
        throw std::invalid_argument("the frame must be a whole number from 0");
    return {static_cast<std::uint64_t>(numbers[0]), box_from(numbers.data() + 1)};
}

class CsvReader {
public:
    explicit CsvReader(const std::filesystem::path& file) : where_{file.string(), 0, 0}, stream_(file) {}

    BoxFrames read() {
        std::string line;
        if (!next(line) || line != csv_header) throw Error(where_, std::string("the first line must be ") + csv_header);
        while (next(line)) {
            if (line.empty()) continue;
            try {
                const auto [frame, box] = parse_box(line);
                take(frame, box);
            } catch (const std::invalid_argument& error) {
                throw Error(where_, error.what());
            }
        }
        close_frame();
        return std::move(frames_);
    }

private:
    bool next(std::string& line) {
        ++where_.line;
        if (!std::getline(stream_, line)) return false;
        if (line.ends_with('\r')) line.pop_back();
        return true;
    }
    void take(std::uint64_t frame, const Aabb& box) {
        if (frames_.empty() || frame > frame_) {
            if (!frames_.empty()) close_frame();
            frames_.emplace_back();
            frame_ = frame;
        } else if (frame < frame_) {
            throw std::invalid_argument("frame " + std::to_string(frame) + " stands after frame " +
                                        std::to_string(frame_));
        }
        frames_.back().push_back(box);
    }
    void close_frame() const {
        if (frames_.empty()) throw Error(where_, "there are no boxes");
        if (frames_.back().size() != frames_.front().size())
            throw Error(where_, "frame " + std::to_string(frame_) + " ends after " +
                                    std::to_string(frames_.back().size()) + " boxes, but the first frame has " +
                                    std::to_string(frames_.front().size()) + ": each frame must list all boxes");
    }

    SourceLocation where_;
    std::ifstream stream_;
    std::uint64_t frame_ = 0;
    BoxFrames frames_;
};

// --- NumPy, format versions 1 to 3 ---------------------------------------------------------------------------------

struct NpyHeader {
    bool is_double = true;
    std::uint64_t frames = 0, boxes = 0;
};

// What follows 'key': in the header's Python dictionary.
std::string_view entry(std::string_view header, const std::string& key) {
    const std::size_t at = header.find("'" + key + "':");
    if (at == std::string_view::npos) throw std::invalid_argument("the header has no '" + key + "'");
    header.remove_prefix(at + key.size() + 3);
    header.remove_prefix(std::min(header.find_first_not_of(' '), header.size()));
    return header;
}

NpyHeader parse_header(std::string_view text) {
    NpyHeader header;
    const std::string_view type = entry(text, "descr");
    header.is_double = type.starts_with("'<f8'");
    if (!header.is_double && !type.starts_with("'<f4'"))
        throw std::invalid_argument("the numbers must be float32 or float64, little endian");
    if (!entry(text, "fortran_order").starts_with("False"))
        throw std::invalid_argument("the array must be in C order (numpy.ascontiguousarray)");
    std::istringstream shape{std::string(entry(text, "shape"))};
    std::uint64_t columns = 0;
    char open = 0, comma = 0, second_comma = 0, close = 0;
    shape >> open >> header.frames >> comma >> header.boxes >> second_comma >> columns >> close;
    if (!shape || open != '(' || comma != ',' || second_comma != ',' || close != ')' || columns != 6)
        throw std::invalid_argument("the shape must be (frames, boxes, 6)");
    if (header.frames == 0 || header.boxes == 0) throw std::invalid_argument("there are no boxes");
    return header;
}

template <class Scalar>
BoxFrames read_array(std::istream& stream, const NpyHeader& header, std::uint64_t bytes) {
    constexpr std::uint64_t box_bytes = 6 * sizeof(Scalar);
    // By division: the product of a made-up shape may overflow.
    if (bytes % box_bytes != 0 || bytes / box_bytes % header.boxes != 0 ||
        bytes / box_bytes / header.boxes != header.frames)
        throw std::invalid_argument("the file has " + std::to_string(bytes) + " bytes of data, which is not its shape");
    BoxFrames frames(header.frames, std::vector<Aabb>(header.boxes));
    for (std::uint64_t frame = 0; frame < header.frames; ++frame)
        for (std::uint64_t box = 0; box < header.boxes; ++box) {
            std::array<Scalar, 6> row;
            stream.read(reinterpret_cast<char*>(row.data()), box_bytes);
            const std::array<double, 6> numbers{row[0], row[1], row[2], row[3], row[4], row[5]};
            try {
                frames[frame][box] = box_from(numbers.data());
            } catch (const std::invalid_argument& error) {
                throw std::invalid_argument("frame " + std::to_string(frame) + ", box " + std::to_string(box) + ": " +
                                            error.what());
            }
        }
    return frames;
}

BoxFrames read_npy(const std::filesystem::path& file) {
    static_assert(std::endian::native == std::endian::little);
    constexpr std::size_t longest_header = 65536;
    std::ifstream stream(file, std::ios::binary);
    std::array<unsigned char, 12> start{};
    stream.read(reinterpret_cast<char*>(start.data()), 10);
    if (!stream || std::memcmp(start.data(), "\x93NUMPY", 6) != 0)
        throw std::invalid_argument("this is not a NumPy .npy file");
    std::size_t length = start[8] + 256u * start[9];
    if (start[6] > 1) {  // from version 2 on the length has four bytes
        stream.read(reinterpret_cast<char*>(start.data() + 10), 2);
        length += 65536u * start[10] + 16777216u * start[11];
    }
    if (!stream || length > longest_header) throw std::invalid_argument("the header is cut short or too long");
    std::string text(length, ' ');
    if (!stream.read(text.data(), static_cast<std::streamsize>(length)))
        throw std::invalid_argument("the header is cut short");
    const NpyHeader header = parse_header(text);
    const std::uint64_t bytes = std::filesystem::file_size(file) - static_cast<std::uint64_t>(stream.tellg());
    return header.is_double ? read_array<double>(stream, header, bytes) : read_array<float>(stream, header, bytes);
}

}  // namespace

BoxFrames read_box_frames(const std::filesystem::path& file) {
    if (!std::filesystem::is_regular_file(file) || !std::ifstream(file))
        throw Error("workload '" + file.string() + "' cannot be read");
    if (file.extension() != ".npy") return CsvReader(file).read();
    try {
        return read_npy(file);
    } catch (const std::invalid_argument& error) {
        throw Error(SourceLocation{file.string(), 0, 0}, error.what());
    }
}

}  // namespace kolize::cli
