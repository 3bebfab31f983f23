// What has no part in the surface: values of any type, nodes of any kind, prototypes and routes.
#include "mesh_io/vrml_values.h"

#include "mesh_io/number.h"

namespace kolize::mesh_io::vrml {

namespace {

char closing_of(TokenKind kind) {
    if (kind == TokenKind::open_brace) return '}';
    return kind == TokenKind::open_bracket ? ']' : '\0';
}

bool is_number(const Token& token) {
    double value;
    return token.kind == TokenKind::word &&
           (parse_number(token.text, value) != NumberFault::not_a_number || token.text.starts_with("0x"));
}

}  // namespace

// Iterative: what is skipped may be nested to any depth.
void ValueReader::skip_to_closing(char closing, Names names) {
    std::string expected(1, closing);
    while (!expected.empty()) {
        const Token token = take();
        if (const char inner = closing_of(token.kind)) {
            expected += inner;
        } else if (token.kind == TokenKind::close_brace || token.kind == TokenKind::close_bracket) {
            if (token.text[0] != expected.back())
                fail(token.line, mesh_io::quoted(expected.substr(expected.size() - 1)) +
                                     " should follow, but here is " + described(token));
            expected.pop_back();
        } else if (token.is("DEF")) {
            const Token name = take_word("a name");
            if (names == Names::keep) skipped_names_.insert(name.text);
        }
    }
}

void ValueReader::skip_body() {
    skip_to_closing('}', Names::keep);
    open_.pop_back();
}

void ValueReader::skip_value() {
    const Token token = take();
    if (token.kind == TokenKind::open_bracket) return skip_to_closing(']', Names::keep);
    if (token.kind == TokenKind::string) return;
    if (token.kind != TokenKind::word)
        fail(token.line, "the value of " + here() + " should follow, but here is " + described(token));
    if (is_number(token)) {
        while (is_number(peek())) take();
        return;
    }
    if (token.is("USE")) {
        take_word("a name");
        return;
    }
    Token type = token;
    if (token.is("DEF")) {
        skipped_names_.insert(take_word("a name").text);
        type = take_word("a node");
    }
    if (peek().kind != TokenKind::open_brace) return;  // TRUE, FALSE, NULL
    open_node(type);
    skip_body();
}

bool ValueReader::skip_statement() {
    const bool route = peek().is("ROUTE"), external = peek().is("EXTERNPROTO");
    if (!route && !external && !peek().is("PROTO")) return false;
    const Token keyword = take();
    notes.pass_over_statement(keyword.text, keyword.line);
    if (route)
        skip_route();
    else
        skip_prototype(external);
    return true;
}

// PROTO name [ interface ] { body }, EXTERNPROTO name [ interface ] url; names in the body are its own.
void ValueReader::skip_prototype(bool external) {
    prototypes_.insert(take_word("the name of a PROTO").text);
    expect(TokenKind::open_bracket, "'[' of a PROTO");
    skip_to_closing(']', Names::drop);
    if (external) {
        list([this] { expect(TokenKind::string, "the address of an EXTERNPROTO"); });
    } else {
        expect(TokenKind::open_brace, "'{' of a PROTO");
        skip_to_closing('}', Names::drop);
    }
}

// ROUTE node.event TO node.event, with or without blanks around the dots.
void ValueReader::skip_route() {
    const auto skip_end = [this] {
        std::string_view text = take_word("the name of an event").text;
        while (text.ends_with('.') || (peek().kind == TokenKind::word && peek().text.starts_with('.')))
            text = take_word("the name of an event").text;
    };
    skip_end();
    const Token to = take();
    if (!to.is("TO")) fail(to.line, "the word TO of a ROUTE should follow, but here is " + described(to));
    skip_end();
}

}  // namespace kolize::mesh_io::vrml
