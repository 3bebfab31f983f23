// Every way in which a file can fail to be a plugin: one exact sentence each, and the good plugin beside it loads.
#include "plugin_folder.h"

#include <catch2/catch.hpp>
#include <elf.h>
#include <sys/stat.h>

#include <cstring>
#include <random>

using namespace kolize;

namespace {

// The one refusal in a folder that holds the good fixture and one file that is not good.
std::string only_refusal(const PluginFolder& folder) {
    const PluginLibrary library({folder.path()});
    CHECK(library.find(StageKind::broadphase, "fixture") != nullptr);
    CHECK(library.plugins().size() == 1);
    REQUIRE(library.refused().size() == 1);
    return library.refused().front().reason;
}

std::string refusal_of_fixture(const std::string& name) {
    CAPTURE(name);
    PluginFolder folder;
    folder.link("good").link(name);
    return only_refusal(folder);
}

std::string refusal_of_bytes(const std::string& bytes) {
    PluginFolder folder;
    folder.link("good").write("bytes.so", bytes);
    return only_refusal(folder);
}

std::string hexadecimal(std::uint64_t number) {
    char text[32];
    std::snprintf(text, sizeof text, "0x%016llx", static_cast<unsigned long long>(number));
    return text;
}

// Where the last mapped segment of a library ends: a file may lose what comes after and still work.
std::size_t needed_bytes(const std::string& library) {
    Elf64_Ehdr header;
    std::memcpy(&header, library.data(), sizeof header);
    std::size_t needed = 0;
    for (int i = 0; i < header.e_phnum; ++i) {
        Elf64_Phdr segment;
        std::memcpy(&segment, library.data() + header.e_phoff + i * sizeof segment, sizeof segment);
        if (segment.p_type == PT_LOAD) needed = std::max<std::size_t>(needed, segment.p_offset + segment.p_filesz);
    }
    return needed;
}

// The good library with one field of its ELF header replaced.
template <class Field>
std::string with_header_field(Field Elf64_Ehdr::*field, Field value) {
    std::string library = good_library();
    Elf64_Ehdr header;
    std::memcpy(&header, library.data(), sizeof header);
    header.*field = value;
    std::memcpy(library.data(), &header, sizeof header);
    return library;
}

}  // namespace

TEST_CASE("a plugin with another ABI tag is refused by the field that differs", "[plugins]") {
    const AbiTag host;
    const std::string alignment = std::to_string(host.eigen_alignment);
    const std::string version = std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
                                std::to_string(EIGEN_MINOR_VERSION);
    CHECK(refusal_of_fixture("other_magic") == "magic number: host 0x6b6f6c697a650a1a, plugin 0x0000000000000007");
    CHECK(refusal_of_fixture("other_api") == "plugin API number: host " + std::to_string(plugin_api) + ", plugin 99");
    CHECK(refusal_of_fixture("other_scalar") == "scalar size (bytes): host 8, plugin 4");
    CHECK(refusal_of_fixture("other_alignment") == "Eigen alignment (compiler flags): host " + alignment + ", plugin " +
                                                       std::to_string(2 * host.eigen_alignment));
    CHECK(refusal_of_fixture("other_eigen") == "Eigen version: host " + version + ", plugin 3.3.9");
    CHECK(refusal_of_fixture("other_strings") == "std::string ABI (_GLIBCXX_USE_CXX11_ABI): host 1, plugin 7");
    CHECK(refusal_of_fixture("other_stl") ==
          "debug standard library (_GLIBCXX_DEBUG): host " + std::to_string(host.debug_stl) + ", plugin 7");
    CHECK(refusal_of_fixture("other_layout") == "layout of the shared types (plugin is stale): host " +
                                                    hexadecimal(host.layout) + ", plugin 0x0000000000000007");
}

TEST_CASE("a plugin with a senseless descriptor is refused by what is missing", "[plugins]") {
    CHECK(refusal_of_fixture("unknown_stage") ==
          "its stage number is 7, must be 0 (broadphase), 1 (narrowphase), 2 (response) or 3 (render)");
    CHECK(refusal_of_fixture("no_name") == "its descriptor gives no name");
    CHECK(refusal_of_fixture("empty_name") == "its descriptor gives no name");
    CHECK(refusal_of_fixture("no_declare") == "its descriptor names no declare function");
    CHECK(refusal_of_fixture("no_create") == "its descriptor names no create function");
    CHECK(refusal_of_fixture("no_destroy") == "its descriptor names no destroy function");
}

TEST_CASE("a plugin whose parameters make no sense is refused", "[plugins]") {
    CHECK(refusal_of_fixture("throwing_declare") == "the declaration of its parameters threw: no parameters today");
    CHECK(refusal_of_fixture("unnamed_parameter") == "it declares a parameter without a name");
    CHECK(refusal_of_fixture("repeated_parameter") == "it declares the parameter 'cell_size' twice");
    CHECK(refusal_of_fixture("default_out_of_range") ==
          "the default of its parameter 'passes' must be from 1 to 8, is 9");
}

TEST_CASE("a library that is no plugin or cannot be loaded is refused with the loader's reason", "[plugins]") {
    CHECK(refusal_of_fixture("no_symbol") == "exports no kolize_plugin: not a kolize plugin");
    CHECK(refusal_of_fixture("undefined_symbol") ==
          "cannot be loaded: undefined symbol: kolize_function_of_another_release");
}

TEST_CASE("a library that fails while it is loaded is refused, every time, and does no harm", "[plugins]") {
    for (int i = 0; i < 2; ++i) {
        CHECK(refusal_of_fixture("throwing_constructor") == "a static constructor threw: no table today");
        CHECK(refusal_of_fixture("ending_constructor") == "ends the process that loads it");
        CHECK(refusal_of_fixture("killing_constructor") == "kills the process that loads it: Killed");
    }
}

TEST_CASE("a file that is no library is refused without being loaded", "[plugins]") {
    const std::string no_header = "is not a shared library: it has no ELF header";
    CHECK(refusal_of_bytes("") == no_header);
    CHECK(refusal_of_bytes("these are not\nthe bytes you are looking for\n") == no_header);
    CHECK(refusal_of_bytes(std::string(10000, 'x')) == no_header);
    const unsigned seed = 20261122;
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::string noise(5000, '\0');
    for (char& byte : noise) byte = static_cast<char>(random());
    CHECK(refusal_of_bytes(noise) == no_header);
}

TEST_CASE("a folder, a dangling link or a pipe with a library's name is refused", "[plugins]") {
    PluginFolder folder;
    folder.link("good");
    SECTION("folder") { std::filesystem::create_directory(folder.path() / "x.so"); }
    SECTION("dangling link") { std::filesystem::create_symlink(folder.path() / "nothing", folder.path() / "x.so"); }
    SECTION("pipe") { REQUIRE(mkfifo(folder.file("x.so").c_str(), 0600) == 0); }
    CHECK(only_refusal(folder) == "is not a regular file");
}

TEST_CASE("a truncated plugin is refused at any length and does not kill the process", "[plugins]") {
    const std::string library = good_library();
    const std::size_t needed = needed_bytes(library);
    REQUIRE(needed > 8192);
    for (const std::size_t length : {needed - 1, needed / 2, std::size_t{8192}, std::size_t{4097}, std::size_t{600}}) {
        CAPTURE(length);
        const std::string reason = refusal_of_bytes(library.substr(0, length));
        CHECK_THAT(reason, Catch::StartsWith("is truncated: it needs "));
        CHECK_THAT(reason, Catch::EndsWith(" bytes and has " + std::to_string(length)));
    }
    CHECK(refusal_of_bytes(library.substr(0, 64)) == "is truncated: it needs 120 bytes and has 64");
    CHECK(refusal_of_bytes(library.substr(0, 63)) == "is truncated: it needs 64 bytes and has 63");
    CHECK(refusal_of_bytes(library.substr(0, 5)) == "is truncated: it needs 64 bytes and has 5");
    CHECK(refusal_of_bytes(library.substr(0, 3)) == "is not a shared library: it has no ELF header");
}

TEST_CASE("a segment table that runs round the end of the numbers is refused", "[plugins]") {
    const std::string reason = refusal_of_bytes(with_header_field<Elf64_Off>(&Elf64_Ehdr::e_phoff, UINT64_MAX - 8));
    CHECK_THAT(reason, Catch::StartsWith("is truncated"));
}

TEST_CASE("a library for another machine, or a program, is refused", "[plugins]") {
    Elf64_Ehdr header;
    std::memcpy(&header, good_library().data(), sizeof header);
    const std::string machine = std::to_string(header.e_machine);
    CHECK(refusal_of_bytes(with_header_field<Elf64_Half>(&Elf64_Ehdr::e_machine, EM_S390)) ==
          "is built for another processor: ELF machine 22, must be " + machine);
    CHECK(refusal_of_bytes(with_header_field<Elf64_Half>(&Elf64_Ehdr::e_type, ET_EXEC)) ==
          "is an ELF file, but not a shared library");
    std::string narrow = good_library();
    narrow[EI_CLASS] = ELFCLASS32;
    CHECK(refusal_of_bytes(narrow) == "is a library for another word size than 64 bits");
}

TEST_CASE("of two plugins with one name in a folder the second is refused and names the first", "[plugins]") {
    PluginFolder folder;
    folder.link("twin_b").link("twin_a").link("good");
    const PluginLibrary library({folder.path()});
    REQUIRE(library.refused().size() == 1);
    CHECK(library.refused().front().file.filename() == "twin_b.so");
    CHECK(library.refused().front().reason == "another broadphase 'twin' is in this folder: twin_a.so");
    CHECK(library.names(StageKind::broadphase) == std::vector<std::string>{"fixture", "twin"});
}

TEST_CASE("a folder full of bad plugins still gives the good ones", "[plugins]") {
    PluginFolder folder;
    folder.link("other_api").link("no_symbol").link("no_create").link("good").link("undefined_symbol");
    folder.write("text.so", "text").write("short.so", good_library().substr(0, 5000));
    const PluginLibrary library({folder.path()});
    CHECK(library.names(StageKind::broadphase) == std::vector<std::string>{"fixture"});
    CHECK(library.refused().size() == 6);
}
