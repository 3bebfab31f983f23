// The bodies of nodes: values of fields, and what is passed over.
#pragma once

#include "mesh_io/vrml_lexer.h"
#include "mesh_io/vrml_notes.h"

#include <unordered_set>

namespace kolize::mesh_io::vrml {

// Nodes of the file stand in one another at most this deep, USE counted as the node that it names.
inline constexpr std::size_t max_depth = 200;

// Every function that reads throws Error with the line if something else stands there, or the file ends: then the
// sentence says in which node, and where that begins.
class ValueReader {
public:
    explicit ValueReader(const MeshFile& file) : lexer_(file) {}

    const Token& peek() const { return lexer_.peek(); }
    Token take();
    // A word, or a failure: "`what` should follow, but here is ...".
    Token take_word(const std::string& what);
    [[noreturn]] void fail(int line, const std::string& message) const { lexer_.fail(line, message); }

    // Takes the brace behind the type of a node. Then next_field takes the names of its fields in turn, and last the
    // closing brace, where it is false; each field's value must be read or skipped. Statements in between are skipped.
    void open_node(const Token& type);
    bool next_field(std::string_view& name);
    std::size_t depth() const { return open_.size(); }

    // A value of the field that next_field named.
    bool boolean();
    double number();
    double positive_number();
    std::int32_t integer();
    Eigen::Vector2d vector2();
    Vec3 vector3();
    Mat3 rotation();  // axis and angle; no rotation if the axis has no direction
    std::string string();

    // Calls read_item for each value of a list: [ a b c ], or one value without brackets.
    template <class ReadItem>
    void list(ReadItem read_item);
    // The value of a field that is of no interest, whatever it is.
    void skip_value();
    // The rest of a node that is of no interest, closing brace and all.
    void skip_body();
    // Skips a PROTO, EXTERNPROTO or ROUTE statement; false if none stands here.
    bool skip_statement();

    // Whether DEF gave this name to a node that was skipped.
    bool is_skipped_name(std::string_view name) const { return skipped_names_.contains(name); }
    // Whether a PROTO of this name was skipped.
    bool is_prototype(std::string_view name) const { return prototypes_.contains(name); }

    Notes notes;

private:
    struct OpenNode {
        Token type;
        std::string_view field;
    };
    enum class Names { keep, drop };

    std::string here() const;
    void expect(TokenKind kind, const std::string& what);
    void skip_to_closing(char closing, Names names);
    void skip_prototype(bool external);
    void skip_route();

    Lexer lexer_;
    std::vector<OpenNode> open_;
    std::unordered_set<std::string_view> skipped_names_;
    std::unordered_set<std::string_view> prototypes_;
};

template <class ReadItem>
void ValueReader::list(ReadItem read_item) {
    if (peek().kind != TokenKind::open_bracket) return read_item();
    take();
    while (peek().kind != TokenKind::close_bracket) read_item();
    take();
}

}  // namespace kolize::mesh_io::vrml
