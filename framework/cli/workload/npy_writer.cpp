#include "npy_writer.h"

#include <kolize/error.h>

#include <bit>

namespace kolize::cli {

NpyWriter::NpyWriter(std::filesystem::path file, std::size_t boxes)
    : file_(std::move(file)), stream_(file_, std::ios::binary), boxes_(boxes) {
    write_header();
}

// Version 1.0 of the format: as long for any number of frames.
void NpyWriter::write_header() {
    constexpr std::size_t length = 128, before_text = 10;
    std::string text = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + std::to_string(frames_) + ", " +
                       std::to_string(boxes_) + ", 6), }";
    text.resize(length - before_text - 1, ' ');
    const char size[2] = {static_cast<char>(length - before_text), 0};
    stream_ << "\x93NUMPY" << '\x01' << '\0';
    stream_.write(size, 2);
    stream_ << text << '\n';
}

void NpyWriter::add(std::span<const Aabb> boxes) {
    static_assert(std::endian::native == std::endian::little);
    for (const Aabb& box : boxes) {
        const double row[] = {box.min.x(), box.min.y(), box.min.z(), box.max.x(), box.max.y(), box.max.z()};
        stream_.write(reinterpret_cast<const char*>(row), sizeof row);
    }
    ++frames_;
    const auto end = stream_.tellp();  // the head is right after every frame, in case the run fails in the next
    stream_.seekp(0);
    write_header();
    stream_.seekp(end);
}

void NpyWriter::finish() {
    if (!stream_.flush()) throw Error("file '" + file_.string() + "' cannot be written");
}

}  // namespace kolize::cli
