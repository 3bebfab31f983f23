#include "exact_numbers.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace kolize::config {
namespace {

constexpr const char* blanks = " \t\r\n";

// The words of a text with the lines that they stand on, counted from 0.
class Words {
public:
    explicit Words(std::string_view text) : text_(text) {}

    bool next() {
        const std::size_t begin = std::min(text_.find_first_not_of(blanks, at_), text_.size());
        line_ += std::count(text_.begin() + at_, text_.begin() + begin, '\n');
        at_ = std::min(text_.find_first_of(blanks, begin), text_.size());
        word_ = text_.substr(begin, at_ - begin);
        return !word_.empty();
    }
    std::string_view word() const { return word_; }
    int line() const { return static_cast<int>(line_); }

private:
    std::string_view text_, word_;
    std::size_t at_ = 0;
    std::ptrdiff_t line_ = 0;
};

std::string wanted(const Range& range) {
    if (range.min == range.max) return to_string(Value(range.min));
    const std::string least = (range.above_min ? "greater than " : "at least ") + to_string(Value(range.min));
    return range.max < infinity ? least + " and at most " + to_string(Value(range.max)) : least;
}

}  // namespace

bool parse_exact(std::string_view word, double& value) {
    const bool negative = word.starts_with('-');
    const std::string_view size = word.substr(negative);
    const bool is_hex = size.starts_with("0x") || size.starts_with("0X");
    const std::string_view digits = is_hex ? size.substr(2) : size;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value,
                                              is_hex ? std::chars_format::hex : std::chars_format::general);
    if (negative) value = -value;
    return error == std::errc() && end == digits.data() + digits.size() && !digits.starts_with('-');
}

std::vector<double> ExactNumbers::numbers(const std::string& key, const Range& range) {
    const toml::node& node = reader_.require(key);
    const std::string text = reader_.text(key, "");
    // A text of several lines begins below its opening quotes.
    const bool is_long = node.source().end.line > node.source().begin.line;
    std::vector<double> values;
    for (Words words(text); words.next();) {
        SourceLocation where = location(node);
        if (is_long) where = {where.file, where.line + 1 + words.line(), 0};
        const auto refuse = [&](const std::string& what) {
            throw Error(where, key + " " + what + ", is " + std::string(words.word().substr(0, 40)));
        };
        double value = 0;
        if (!parse_exact(words.word(), value)) refuse("must be made of numbers such as 0x1.8p+1");
        if (!std::isfinite(value)) refuse("must be finite");
        if (value < range.min || value > range.max || (range.above_min && value == range.min))
            refuse("must be " + wanted(range));
        values.push_back(value);
    }
    return values;
}

std::vector<double> ExactNumbers::numbers(const std::string& key, std::size_t count, const Range& range) {
    const std::vector<double> values = numbers(key, range);
    if (values.size() != count)
        reader_.refuse(key, "must have " + std::to_string(count) + (count == 1 ? " number" : " numbers") + ", has " +
                                std::to_string(values.size()));
    return values;
}

double ExactNumbers::number(const std::string& key, const Range& range) { return numbers(key, 1, range)[0]; }

Vec3 ExactNumbers::vector(const std::string& key, const Range& range) {
    const std::vector<double> v = numbers(key, 3, range);
    return {v[0], v[1], v[2]};
}

Quat ExactNumbers::unit_quaternion(const std::string& key) {
    const std::vector<double> q = numbers(key, 4, {});
    try {
        config::unit_quaternion(q[0], q[1], q[2], q[3]);
    } catch (const std::invalid_argument& error) {
        reader_.refuse(key, error.what());
    }
    return {q[0], q[1], q[2], q[3]};
}

std::vector<Vec3> ExactNumbers::vectors(const std::string& key) {
    const std::vector<double> values = numbers(key, Range{});
    if (values.size() % 3)
        reader_.refuse(key, "must have three numbers for each, has " + std::to_string(values.size()));
    std::vector<Vec3> result;
    for (std::size_t i = 0; i < values.size(); i += 3) result.emplace_back(values[i], values[i + 1], values[i + 2]);
    return result;
}

std::vector<Triangle> ExactNumbers::triangles(const std::string& key, std::size_t end) {
    const std::vector<double> values = numbers(key, non_negative);
    if (values.size() % 3)
        reader_.refuse(key, "must have three corners for each, has " + std::to_string(values.size()));
    std::vector<Triangle> result;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] != std::floor(values[i]) || !(values[i] < static_cast<double>(end)))
            reader_.refuse(key, "must be made of numbers of vertices, of which there are " + std::to_string(end) +
                                    ", counted from 0; one is " + to_string(Value(values[i])));
        if (i % 3 == 0) result.emplace_back();
        result.back()[i % 3] = static_cast<std::uint32_t>(values[i]);
    }
    return result;
}

}  // namespace kolize::config
