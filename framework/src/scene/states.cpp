#include "parts.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace kolize::config {
namespace {

const std::vector<std::string> columns = {"x",  "y",  "z",  "qw", "qx", "qy", "qz",
                                          "vx", "vy", "vz", "wx", "wy", "wz", "mass"};
enum Column : std::size_t { x = 0, qw = 3, vx = 7, wx = 10, mass = 13 };

struct Cell {
    std::string_view text;  // trimmed
    int column;             // of its first character in the line, from 1
};

std::vector<Cell> split(std::string_view line) {
    std::vector<Cell> cells;
    for (std::size_t begin = 0; begin <= line.size();) {
        const std::size_t end = std::min(line.find(',', begin), line.size());
        std::size_t first = begin, last = end;
        while (first < last && std::isspace(static_cast<unsigned char>(line[first]))) ++first;
        while (last > first && std::isspace(static_cast<unsigned char>(line[last - 1]))) --last;
        cells.push_back({line.substr(first, last - first), static_cast<int>(first) + 1});
        begin = end + 1;
    }
    return cells;
}

bool is_number(const Cell& cell) {
    double value = 0;
    return std::from_chars(cell.text.data(), cell.text.data() + cell.text.size(), value).ec == std::errc();
}

bool blank(const std::vector<Cell>& cells) { return cells.size() == 1 && cells[0].text.empty(); }

class StateReader {
public:
    StateReader(const std::filesystem::path& file, const std::vector<std::string>& headerless)
        : file_(file.string()), stream_(file), headerless_(headerless) {
        if (!stream_ || std::filesystem::is_directory(file)) throw Error("table '" + file_ + "' cannot be read");
    }

    std::vector<BodyDescription> read() {
        std::vector<BodyDescription> rows;
        while (next_line())
            if (const std::vector<Cell> cells = split(text_); !blank(cells)) {
                if (order_.empty() && (headerless_.empty() || !is_number(cells[0]))) {
                    read_header(cells);
                    continue;
                }
                if (order_.empty()) read_header(split(join(headerless_)));
                rows.push_back(read_row(cells));
            }
        if (order_.empty())
            throw Error(at(1), "the table is empty; its first line must name columns: " + join(columns));
        return rows;
    }

private:
    SourceLocation at(int column) const { return {file_, std::max(line_, 1), column}; }

    bool next_line() {
        if (!std::getline(stream_, text_)) return false;
        if (++line_ == 1 && text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);  // byte order mark of spreadsheets
        return true;
    }

    void read_header(const std::vector<Cell>& cells) {
        for (const Cell& cell : cells) {
            const std::string name(cell.text);
            const auto found = std::find(columns.begin(), columns.end(), name);
            if (found == columns.end())
                throw Error(at(cell.column), "no column '" + name + "' in a table of states" + hint(name, columns));
            const auto index = static_cast<std::size_t>(found - columns.begin());
            if (std::find(order_.begin(), order_.end(), index) != order_.end())
                throw Error(at(cell.column), "column '" + name + "' stands there twice");
            order_.push_back(index);
        }
    }

    BodyDescription read_row(const std::vector<Cell>& cells) const {
        if (cells.size() != order_.size())
            throw Error(at(1), "the row has " + std::to_string(cells.size()) + " values for " +
                                   std::to_string(order_.size()) + " columns");
        std::array<double, 14> value{};
        value[qw] = has_quaternion() ? 0 : 1;
        for (std::size_t i = 0; i < cells.size(); ++i) value[order_[i]] = parse(cells[i], columns[order_[i]]);
        return body(value, cells);
    }

    // A table that names some of the four columns means 0 for the others; one that names none, no turn.
    bool has_quaternion() const {
        return std::any_of(order_.begin(), order_.end(), [](std::size_t i) { return i >= qw && i < vx; });
    }

    double parse(const Cell& cell, const std::string& name) const {
        double value = 0;
        const char* const end = cell.text.data() + cell.text.size();
        const auto [stop, error] = std::from_chars(cell.text.data(), end, value);
        if (error != std::errc() || stop != end)
            throw Error(at(cell.column), name + " must be a number, is \"" + std::string(cell.text) + "\"");
        if (!std::isfinite(value)) throw Error(at(cell.column), name + " must be finite, is " + std::string(cell.text));
        return value;
    }

    int column_of(std::size_t column, const std::vector<Cell>& cells) const {
        for (std::size_t i = 0; i < order_.size(); ++i)
            if (order_[i] >= column) return cells[i].column;
        return 1;
    }

    BodyDescription body(const std::array<double, 14>& value, const std::vector<Cell>& cells) const {
        const auto vector = [&](Column first) { return Vec3(value[first], value[first + 1], value[first + 2]); };
        BodyDescription body;
        body.position = vector(x);
        body.velocity = vector(vx);
        body.angular_velocity = vector(wx);
        body.mass = value[mass];
        const bool has_mass = std::find(order_.begin(), order_.end(), mass) != order_.end();
        if (has_mass && !(body.mass > 0)) throw Error(at(column_of(mass, cells)), "mass must be greater than 0");
        try {
            body.orientation = unit_quaternion(value[qw], value[qw + 1], value[qw + 2], value[qw + 3]);
        } catch (const std::invalid_argument& error) {
            throw Error(at(column_of(qw, cells)), std::string("qw, qx, qy, qz ") + error.what());
        }
        return body;
    }

    std::string file_;
    std::ifstream stream_;
    std::vector<std::string> headerless_;  // columns of a table without a header
    std::string text_;
    int line_ = 0;
    std::vector<std::size_t> order_;  // of the file's columns, as indices into `columns`
};

}  // namespace
}  // namespace kolize::config

namespace kolize {

std::vector<BodyDescription> read_states(const std::filesystem::path& file, const std::vector<std::string>& columns) {
    return config::StateReader(file, columns).read();
}

}  // namespace kolize
