#include "mesh_io/scanner.h"

#include "mesh_io/number.h"

#include <algorithm>
#include <charconv>

namespace kolize::mesh_io {

namespace {

bool is_blank(char c) { return static_cast<unsigned char>(c) <= ' '; }

}  // namespace

Scanner::Scanner(const MeshFile& file, std::string_view text, Layout layout, int first_line)
    : file_(file.name), text_(text), layout_(layout), line_(first_line) {
    const std::size_t zero = text.find('\0');
    if (zero == std::string_view::npos) return;
    line_ += static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(zero), '\n'));
    fail("there is a zero byte in what should be text");
}

void Scanner::fail(const std::string& message) const { throw Error(SourceLocation{file_, line_}, message); }

// Length of the backslash and line break that stand here, or 0.
std::size_t Scanner::continuation() const {
    if (text_[position_] != '\\' || layout_ != Layout::continued_lines) return 0;
    const std::string_view rest = text_.substr(position_, 3);
    if (rest.starts_with("\\\n")) return 2;
    return rest == "\\\r\n" ? 3 : 0;
}

void Scanner::skip_blanks() {
    for (; !at_end(); ++position_) {
        const char c = text_[position_];
        if (c == '#') {
            position_ = std::min(text_.find('\n', position_), text_.size()) - 1;
        } else if (c == '\n') {
            if (layout_ != Layout::free_form) return;
            ++line_;
        } else if (!is_blank(c)) {
            const std::size_t length = continuation();
            if (length == 0) return;
            position_ += length - 1;
            ++line_;
        }
    }
}

std::string_view Scanner::word() {
    skip_blanks();
    const std::size_t begin = position_;
    while (!at_end() && !is_blank(text_[position_]) && text_[position_] != '#' && continuation() == 0) ++position_;
    return text_.substr(begin, position_ - begin);
}

void Scanner::skip_line() {
    if (layout_ == Layout::continued_lines)
        while (!word().empty()) {
        }  // to the end of the last line that continues this one
    position_ = std::min(text_.find('\n', position_), text_.size());
    if (at_end()) return;
    ++position_;
    ++line_;
}

double Scanner::number(const char* what) {
    const std::string_view whole = word();
    if (whole.empty()) fail(std::string(what) + " is missing");
    double value = 0;
    const NumberFault fault = parse_number(whole, value);
    if (fault == NumberFault::not_a_number) fail(std::string(what) + " must be a number, is " + quoted(whole));
    if (fault == NumberFault::not_finite)
        fail(std::string(what) + " must be finite and within the range of a double, is " + quoted(whole));
    return value;
}

std::int64_t Scanner::take_integer(std::string_view& word, const char* what) const {
    const std::string_view digits = without_plus(word);
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(digits.begin(), digits.end(), value);
    if (error != std::errc()) fail(std::string(what) + " must be an integer, is " + quoted(word));
    word = {end, static_cast<std::size_t>(digits.end() - end)};
    return value;
}

std::int64_t Scanner::integer(const char* what) {
    const std::string_view whole = word();
    if (whole.empty()) fail(std::string(what) + " is missing");
    std::string_view rest = whole;
    const std::int64_t value = take_integer(rest, what);
    if (!rest.empty()) fail(std::string(what) + " must be an integer, is " + quoted(whole));
    return value;
}

Vec3 Scanner::point(const char* what) {
    Vec3 p;
    for (double& coordinate : p) coordinate = number(what);
    return p;
}

}  // namespace kolize::mesh_io
