#include "mesh_io/vrml_lexer.h"

namespace kolize::mesh_io::vrml {

namespace {

bool is_blank(char c) { return static_cast<unsigned char>(c) <= ' ' || c == ','; }

bool ends_word(char c) { return is_blank(c) || std::string_view("\"#[]{}").find(c) != std::string_view::npos; }

TokenKind bracket_kind(char c) {
    if (c == '{') return TokenKind::open_brace;
    if (c == '}') return TokenKind::close_brace;
    if (c == '[') return TokenKind::open_bracket;
    if (c == ']') return TokenKind::close_bracket;
    return TokenKind::word;
}

}  // namespace

std::string described(const Token& token) {
    if (token.kind == TokenKind::end) return "the end of the file";
    if (token.kind == TokenKind::string) return "the string " + quoted(token.text);
    return quoted(token.text);
}

std::string unescaped(const Token& string) {
    std::string text;
    for (std::size_t i = 0; i < string.text.size(); ++i) {
        const bool escape = string.text[i] == '\\' && i + 1 < string.text.size() &&
                            (string.text[i + 1] == '"' || string.text[i + 1] == '\\');
        text += string.text[escape ? ++i : i];
    }
    return text;
}

Lexer::Lexer(const MeshFile& file) : file_(file.name), text_(file.bytes) {
    if (text_.find('\0') != std::string_view::npos)
        throw Error(SourceLocation{file_}, "there is a zero byte in what should be text");
    if (text_.starts_with("\xef\xbb\xbf")) position_ = 3;  // the mark that some editors put before UTF-8
    ahead_ = scan();
}

void Lexer::fail(int line, const std::string& message) const { throw Error(SourceLocation{file_, line}, message); }

Token Lexer::next() {
    const Token token = ahead_;
    ahead_ = scan();
    return token;
}

// CRLF ends a line with its second character.
bool Lexer::line_ends_here() const {
    const std::string_view rest = text_.substr(position_, 2);
    return rest.starts_with('\n') || (rest.starts_with('\r') && rest != "\r\n");
}

void Lexer::skip_blanks() {
    bool comment = false;
    for (; position_ < text_.size(); ++position_) {
        if (text_[position_] == '#') comment = true;
        if (line_ends_here()) {
            comment = false;
            ++line_;
        }
        if (!comment && !is_blank(text_[position_])) return;
    }
}

Token Lexer::scan() {
    skip_blanks();
    if (position_ == text_.size()) return {TokenKind::end, {}, line_};
    if (text_[position_] == '"') return scan_string();
    const std::size_t begin = position_++;
    const TokenKind kind = bracket_kind(text_[begin]);
    if (kind == TokenKind::word)
        while (position_ < text_.size() && !ends_word(text_[position_])) ++position_;
    return {kind, text_.substr(begin, position_ - begin), line_};
}

Token Lexer::scan_string() {
    const std::size_t begin = ++position_;
    const int first_line = line_;
    bool escaped = false;
    for (; position_ < text_.size(); ++position_) {
        if (text_[position_] == '"' && !escaped)
            return {TokenKind::string, text_.substr(begin, position_++ - begin), first_line};
        escaped = text_[position_] == '\\' && !escaped;
        if (line_ends_here()) ++line_;
    }
    fail(first_line, "the string that begins here has no end");
}

}  // namespace kolize::mesh_io::vrml
