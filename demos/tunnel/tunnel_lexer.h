// Words, brackets and comments of a tunnel's file.
#pragma once

#include <kolize/error.h>

#include <string>

namespace kolize::tunnel {

// A word, or one bracket; empty at the end of the file.
struct Token {
    std::string text;
    SourceLocation where;
};

class Lexer {
public:
    Lexer(const std::string& text, const std::string& file) : text_(text), here_{file, 1, 1} {}

    // Throws Error for a comment without an end.
    Token next();

private:
    bool at(const char* text) const {
        return text_.compare(position_, std::char_traits<char>::length(text), text) == 0;
    }
    bool at_end() const { return position_ == text_.size(); }
    void advance();
    void skip_space_and_comments();

    const std::string& text_;
    std::size_t position_ = 0;
    SourceLocation here_;
};

}  // namespace kolize::tunnel
