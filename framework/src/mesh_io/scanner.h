// Words and numbers of a text file, with the line they stand on.
#pragma once

#include "mesh_io/formats.h"

namespace kolize::mesh_io {

enum class Layout {
    lines,            // a line is a statement
    continued_lines,  // the same, and a backslash at the end of a line continues it
    free_form         // line breaks are blanks
};

// '#' begins a comment. Every failure throws Error with file and line.
class Scanner {
public:
    Scanner(const MeshFile& file, std::string_view text, Layout layout, int first_line = 1);

    bool at_end() const { return position_ == text_.size(); }
    // The next word of the line (of the text, if free form); empty when there is none left.
    std::string_view word();
    // Moves behind the end of the line.
    void skip_line();

    // The next word as a finite number, an integer, or three numbers; `what` names it in messages.
    double number(const char* what);
    std::int64_t integer(const char* what);
    Vec3 point(const char* what);

    // Reads an integer from the front of a word of this line and takes it off.
    std::int64_t take_integer(std::string_view& word, const char* what) const;

    std::size_t remaining() const { return text_.size() - position_; }
    int line() const { return line_; }
    [[noreturn]] void fail(const std::string& message) const;

private:
    void skip_blanks();
    std::size_t continuation() const;

    std::string file_;
    std::string_view text_;
    Layout layout_;
    std::size_t position_ = 0;
    int line_;
};

}  // namespace kolize::mesh_io
