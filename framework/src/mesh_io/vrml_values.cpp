#include "mesh_io/vrml_values.h"

#include "mesh_io/number.h"

#include <charconv>

namespace kolize::mesh_io::vrml {

Token ValueReader::take() {
    if (peek().kind != TokenKind::end) return lexer_.next();
    if (open_.empty()) fail(peek().line, "the file ends in the middle of a statement");
    const Token& type = open_.back().type;
    fail(peek().line,
         "the file ends inside " + printable(type.text) + ", which begins in line " + std::to_string(type.line));
}

Token ValueReader::take_word(const std::string& what) {
    const Token token = take();
    if (token.kind != TokenKind::word) fail(token.line, what + " should follow, but here is " + described(token));
    return token;
}

void ValueReader::expect(TokenKind kind, const std::string& what) {
    const Token token = take();
    if (token.kind != kind) fail(token.line, what + " should follow, but here is " + described(token));
}

void ValueReader::open_node(const Token& type) {
    if (open_.size() == max_depth)
        fail(type.line, "nodes stand in one another more than " + std::to_string(max_depth) + " deep");
    expect(TokenKind::open_brace, "'{' of " + printable(type.text));
    open_.push_back({type, {}});
}

bool ValueReader::next_field(std::string_view& name) {
    for (;;) {
        if (peek().kind == TokenKind::close_brace) {
            take();
            open_.pop_back();
            return false;
        }
        if (skip_statement()) continue;
        const Token word = take_word("a field of " + printable(open_.back().type.text) + " or its '}'");
        name = open_.back().field = word.text;
        if (!peek().is("IS")) return true;
        take();
        take_word("the name of a field of the PROTO");
    }
}

// "radius in Sphere"
std::string ValueReader::here() const {
    return printable(open_.back().field) + " in " + printable(open_.back().type.text);
}

bool ValueReader::boolean() {
    const Token token = take();
    if (!token.is("TRUE") && !token.is("FALSE"))
        fail(token.line, here() + " must be TRUE or FALSE, is " + described(token));
    return token.text == "TRUE";
}

double ValueReader::number() {
    const Token token = take();
    double value = 0;
    const NumberFault fault =
        token.kind == TokenKind::word ? parse_number(token.text, value) : NumberFault::not_a_number;
    if (fault == NumberFault::not_a_number) fail(token.line, here() + " must be a number, is " + described(token));
    if (fault == NumberFault::not_finite)
        fail(token.line, here() + " must be finite and within the range of a double, is " + described(token));
    return value;
}

double ValueReader::positive_number() {
    const int line = peek().line;
    const double value = number();
    if (value <= 0) fail(line, here() + " must be positive, is " + shortest_text(value));
    return value;
}

std::int32_t ValueReader::integer() {
    const Token token = take();
    std::string_view digits = token.kind == TokenKind::word ? without_plus(token.text) : std::string_view();
    const bool negative = digits.starts_with('-');
    if (negative) digits.remove_prefix(1);
    const bool hexadecimal = digits.starts_with("0x") || digits.starts_with("0X");
    if (hexadecimal) digits.remove_prefix(2);
    std::uint32_t magnitude = 0;
    const auto [end, error] = std::from_chars(digits.begin(), digits.end(), magnitude, hexadecimal ? 16 : 10);
    if (end != digits.end() || error != std::errc() || magnitude > 0x7fffffff)
        fail(token.line, here() + " must be an integer of 32 bits, is " + described(token));
    return negative ? -static_cast<std::int32_t>(magnitude) : static_cast<std::int32_t>(magnitude);
}

Eigen::Vector2d ValueReader::vector2() {
    const double x = number();
    return {x, number()};
}

Vec3 ValueReader::vector3() {
    Vec3 v;
    for (double& x : v) x = number();
    return v;
}

Mat3 ValueReader::rotation() {
    const Vec3 axis = vector3().stableNormalized();
    const double angle = number();
    if (axis.isZero()) return Mat3::Identity();
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

std::string ValueReader::string() {
    const Token token = take();
    if (token.kind != TokenKind::string)
        fail(token.line, here() + " must be a string in quotes, is " + described(token));
    return unescaped(token);
}

}  // namespace kolize::mesh_io::vrml
