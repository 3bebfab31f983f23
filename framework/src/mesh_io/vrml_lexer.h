// Tokens of a VRML97 file (ISO/IEC 14772-1, annex A).
#pragma once

#include "mesh_io/formats.h"

namespace kolize::mesh_io::vrml {

enum class TokenKind { end, word, string, open_brace, close_brace, open_bracket, close_bracket };

// A word is a name, a keyword or a number. More characters are taken in names than the standard allows, such as the
// dots that many programs write there.
struct Token {
    TokenKind kind = TokenKind::end;
    std::string_view text;  // into the file; of a string what stands between the quotes, escapes and all
    int line = 0;

    bool is(std::string_view keyword) const { return kind == TokenKind::word && text == keyword; }
};

// As it can stand in a message: 'word', "the end of the file".
std::string described(const Token& token);

// What a string token stands for: \" and \\ without the backslash.
std::string unescaped(const Token& string);

// Looks one token ahead. Lines end with LF, CR or CRLF.
class Lexer {
public:
    // Throws Error if there is a zero byte.
    explicit Lexer(const MeshFile& file);

    const Token& peek() const { return ahead_; }
    // The end of the file comes again and again.
    Token next();

    [[noreturn]] void fail(int line, const std::string& message) const;

private:
    bool line_ends_here() const;
    void skip_blanks();
    Token scan();
    Token scan_string();

    std::string file_;
    std::string_view text_;
    std::size_t position_ = 0;
    int line_ = 1;
    Token ahead_;
};

}  // namespace kolize::mesh_io::vrml
