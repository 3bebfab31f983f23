#include "mesh_io/ply_header.h"

#include "mesh_io/scanner.h"

namespace kolize::mesh_io {

namespace {

PlyScalar scalar_type(const Scanner& in, std::string_view word) {
    constexpr std::string_view names[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                             {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                             {"float", "float32"}, {"double", "float64"}};
    for (std::size_t i = 0; i < std::size(names); ++i)
        if (word == names[i][0] || word == names[i][1]) return static_cast<PlyScalar>(i);
    in.fail("the type of a property must be one of char, uchar, short, ushort, int, uint, float, double, is " +
            quoted(word));
}

PlyEncoding read_encoding(Scanner& in) {
    const std::string_view word = in.word();
    if (word == "ascii") return PlyEncoding::text;
    if (word == "binary_little_endian") return PlyEncoding::little_endian;
    if (word == "binary_big_endian") return PlyEncoding::big_endian;
    in.fail("the format must be ascii, binary_little_endian or binary_big_endian, is " + quoted(word));
}

PlyElement read_element(Scanner& in) {
    PlyElement element;
    element.name = in.word();
    const std::int64_t count = in.integer("the number of rows of an element");
    if (count < 0) in.fail("the number of rows of an element must not be negative, is " + std::to_string(count));
    element.count = static_cast<std::uint64_t>(count);
    element.line = in.line();
    return element;
}

PlyProperty read_property(Scanner& in) {
    PlyProperty property;
    std::string_view type = in.word();
    if (type == "list") {
        property.count = scalar_type(in, in.word());
        type = in.word();
    }
    property.type = scalar_type(in, type);
    property.name = in.word();
    if (property.name.empty()) in.fail("the name of a property is missing");
    return property;
}

void read_statement(Scanner& in, PlyHeader& header) {
    const std::string_view keyword = in.word();
    if (keyword == "format") {
        header.encoding = read_encoding(in);
    } else if (keyword == "element") {
        header.elements.push_back(read_element(in));
    } else if (keyword == "property") {
        if (header.elements.empty()) in.fail("a property must follow its element");
        header.elements.back().properties.push_back(read_property(in));
    } else if (keyword != "ply" && keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
        in.fail("a header line must begin with format, element, property, comment or end_header, not " +
                quoted(keyword));
    }
}

}  // namespace

std::size_t PlyElement::require_property(const MeshFile& file, std::string_view wanted, bool list) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
        if (properties[i].name == wanted && properties[i].count.has_value() == list) return i;
    throw Error(SourceLocation{file.name, line},
                "element " + quoted(name) + " has no " + (list ? "list " : "number ") + quoted(wanted));
}

PlyHeader read_ply_header(const MeshFile& file) {
    if (!file.bytes.starts_with("ply"))
        throw Error(SourceLocation{file.name, 1}, "a PLY file begins with the word ply");
    const std::size_t end = file.bytes.find("\nend_header");
    const std::size_t body = file.bytes.find('\n', end == std::string_view::npos ? end : end + 1);
    if (body == std::string_view::npos) throw Error(SourceLocation{file.name}, "the header has no line 'end_header'");
    PlyHeader header;
    Scanner in(file, file.bytes.substr(0, end + 1), Layout::lines);
    for (; !in.at_end(); in.skip_line()) read_statement(in, header);
    if (!header.encoding) in.fail("the header has no line 'format'");
    header.body = file.bytes.substr(body + 1);
    header.body_line = in.line() + 1;
    return header;
}

}  // namespace kolize::mesh_io
