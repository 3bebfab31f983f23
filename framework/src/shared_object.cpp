#include "shared_object.h"

#include <elf.h>

#include <cstring>
#include <fstream>

namespace kolize {

namespace {

#if defined(__x86_64__)
constexpr Elf64_Half machine = EM_X86_64;
#elif defined(__aarch64__)
constexpr Elf64_Half machine = EM_AARCH64;
#endif

template <class T>
bool read_at(std::ifstream& in, std::uint64_t offset, T& value) {
    in.seekg(static_cast<std::streamoff>(offset));
    return static_cast<bool>(in.read(reinterpret_cast<char*>(&value), sizeof value));
}

std::string header_defect(const Elf64_Ehdr& header) {
    if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0) return "is not a shared library: it has no ELF header";
    if (header.e_ident[EI_CLASS] != ELFCLASS64) return "is a library for another word size than 64 bits";
    if (header.e_ident[EI_DATA] != ELFDATA2LSB || header.e_machine != machine)
        return "is built for another processor: ELF machine " + std::to_string(header.e_machine) + ", must be " +
               std::to_string(machine);
    if (header.e_type != ET_DYN) return "is an ELF file, but not a shared library";
    if (header.e_phentsize != sizeof(Elf64_Phdr)) return "has a damaged ELF header";
    return "";
}

// The segments need the file to reach this far; the largest number of all if that overflows.
std::uint64_t end_of(const Elf64_Phdr& segment) {
    const std::uint64_t end = segment.p_offset + segment.p_filesz;
    return end < segment.p_offset ? UINT64_MAX : end;
}

std::string truncation(std::uint64_t needed, std::uint64_t size) {
    return "is truncated: it needs " + std::to_string(needed) + " bytes and has " + std::to_string(size);
}

std::string segment_defect(std::ifstream& in, const Elf64_Ehdr& header, std::uint64_t size) {
    for (unsigned i = 0; i < header.e_phnum; ++i) {
        Elf64_Phdr segment;
        const std::uint64_t offset = header.e_phoff + i * sizeof segment;
        if (!read_at(in, offset, segment)) return truncation(offset + sizeof segment, size);
        if (segment.p_type == PT_LOAD && end_of(segment) > size) return truncation(end_of(segment), size);
    }
    return "";
}

}  // namespace

std::string shared_object_defect(const std::filesystem::path& file) {
    // Before opening: to open a pipe would wait for ever.
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return "is not a regular file";
    std::ifstream in(file, std::ios::binary);
    if (!in) return "cannot be opened for reading";
    Elf64_Ehdr header{};
    if (!read_at(in, 0, header)) {
        const bool begins_as_elf = std::memcmp(header.e_ident, ELFMAG, SELFMAG) == 0;
        if (begins_as_elf) return truncation(sizeof header, std::filesystem::file_size(file, ignored));
        return "is not a shared library: it has no ELF header";
    }
    const std::string defect = header_defect(header);
    return defect.empty() ? segment_defect(in, header, std::filesystem::file_size(file, ignored)) : defect;
}

}  // namespace kolize
