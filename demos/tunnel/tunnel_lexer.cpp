#include "tunnel_lexer.h"

namespace kolize::tunnel {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v'; }
bool is_bracket(char c) { return c == '(' || c == ')'; }

}  // namespace

void Lexer::advance() {
    if (text_[position_++] == '\n') {
        ++here_.line;
        here_.column = 1;
    } else {
        ++here_.column;
    }
}

void Lexer::skip_space_and_comments() {
    while (!at_end()) {
        if (is_space(text_[position_])) {
            advance();
            continue;
        }
        if (!at("/*")) return;
        const SourceLocation start = here_;
        const std::size_t end = text_.find("*/", position_ + 2);
        if (end == std::string::npos) throw Error(start, "this comment has no end; it takes a */");
        while (position_ < end + 2) advance();
    }
}

Token Lexer::next() {
    skip_space_and_comments();
    Token token{"", here_};
    while (!at_end() && !is_space(text_[position_]) && !at("/*")) {
        const bool bracket = is_bracket(text_[position_]);
        if (bracket && !token.text.empty()) break;
        token.text += text_[position_];
        advance();
        if (bracket) break;
    }
    return token;
}

}  // namespace kolize::tunnel
