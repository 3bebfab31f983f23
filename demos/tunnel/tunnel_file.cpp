#include "tunnel_file.h"

#include "tunnel_lexer.h"
#include "tunnel_path.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <optional>

namespace kolize::tunnel {
namespace {

std::string quoted(const Token& token) { return token.text.empty() ? "the end of the file" : "'" + token.text + "'"; }

std::optional<CellType> type_of(const std::string& word) {
    if (word == "S") return CellType::end;
    if (word == "I") return CellType::straight;
    if (word == "L") return CellType::left;
    if (word == "R") return CellType::right;
    return {};
}

class Parser {
public:
    Parser(const std::string& text, const std::string& file) : lexer_(text, file) {}

    std::vector<Cell> cells() {
        std::vector<Cell> cells;
        for (Token token = lexer_.next(); !token.text.empty(); token = lexer_.next()) {
            if (cells.size() == max_cells)
                throw Error(token.where, "a tunnel has at most " + std::to_string(max_cells) + " cells");
            cells.push_back(cell(token));
        }
        return cells;
    }

private:
    Cell cell(const Token& type) {
        Cell cell;
        const std::optional<CellType> known = type_of(type.text);
        if (!known) throw Error(type.where, "a cell begins with its type, S, I, L or R, not with " + quoted(type));
        cell.type = *known;
        cell.where = type.where;
        cell.place = place();
        const SourceLocation where = next_where();
        cell.rotation = cube_rotation(orientation(), where);
        cell.statics = bodies("statics");
        cell.dynamics = bodies("dynamics");
        return cell;
    }

    Place place() {
        Place place;
        expect("(");
        for (int axis = 0; axis < 3; ++axis) {
            const SourceLocation where = next_where();
            const double value = number();
            if (value != std::round(value))
                throw Error(where, "a cell stands at a whole number of cubes, not at " + last_.text);
            if (std::abs(value) > max_place)
                throw Error(where, "a cell stands at most " + std::to_string(max_place) + " cubes from the origin");
            place[axis] = static_cast<int>(value);
        }
        expect(")");
        return place;
    }

    Vec3 vector() {
        Vec3 vector;
        expect("(");
        for (double& coordinate : vector) coordinate = number();
        expect(")");
        return vector;
    }

    // An axis, and the angle about it in multiples of pi.
    Quat orientation() {
        const SourceLocation where = next_where();
        const Vec3 axis = vector();
        const double length = axis.stableNorm();
        if (!std::isnormal(length)) throw Error(where, "the axis of a rotation must have a length above 0");
        const double turns = std::remainder(number(), 2.0);
        return Quat(Eigen::AngleAxisd(turns * std::numbers::pi, axis / length)).normalized();
    }

    static Mat3 cube_rotation(const Quat& orientation, const SourceLocation& where) {
        const Mat3 rotation = orientation.toRotationMatrix();
        const Mat3 whole = rotation.array().round();
        if (!rotation.isApprox(whole, 1e-6))
            throw Error(where,
                        "the rotation of a cell must map the cube to itself: 0.5 or 1.0 about an edge of it, say");
        return whole;
    }

    std::vector<PlacedBody> bodies(const std::string& what) {
        std::vector<PlacedBody> bodies;
        for (Token token = take(); token.text != "END"; token = take()) {
            if (token.text.empty() || type_of(token.text))
                throw Error(token.where, "the " + what + " of this cell have no END before " + quoted(token));
            if (token.text == "(" || token.text == ")")
                throw Error(token.where, "a mesh file, 'ball' or END is wanted here, not " + quoted(token));
            if (++bodies_ > max_bodies)
                throw Error(token.where, "a tunnel has at most " + std::to_string(max_bodies) + " bodies");
            PlacedBody body;
            body.file = token.text;
            body.where = token.where;
            body.position = vector();
            body.orientation = orientation();
            bodies.push_back(body);
        }
        return bodies;
    }

    double number() {
        const Token token = take();
        double value = 0;
        const char* end = token.text.data() + token.text.size();
        const auto [rest, error] = std::from_chars(token.text.data(), end, value);
        if (token.text.empty() || error == std::errc::invalid_argument || rest != end)
            throw Error(token.where, "a number is wanted here, not " + quoted(token));
        if (error != std::errc() || !std::isfinite(value))
            throw Error(token.where, "a number must be finite, not " + quoted(token));
        return value;
    }

    void expect(const std::string& bracket) {
        const Token token = take();
        if (token.text != bracket) throw Error(token.where, "a '" + bracket + "' is wanted here, not " + quoted(token));
    }

    Token take() {
        last_ = ahead_ ? *ahead_ : lexer_.next();
        ahead_.reset();
        return last_;
    }
    SourceLocation next_where() {
        if (!ahead_) ahead_ = lexer_.next();
        return ahead_->where;
    }

    Lexer lexer_;
    std::optional<Token> ahead_;
    Token last_;
    std::size_t bodies_ = 0;
};

}  // namespace

Tunnel parse_tunnel(const std::string& text, const std::filesystem::path& file) {
    Parser parser(text, file.string());
    return {file, in_order_of_flight(parser.cells(), file.string())};
}

Tunnel read_tunnel(const std::filesystem::path& file) {
    constexpr std::uintmax_t max_bytes = 16u << 20;
    std::error_code failure;
    if (!std::filesystem::is_regular_file(file, failure))
        throw Error(SourceLocation{file.string()}, "there is no such tunnel file");
    if (std::filesystem::file_size(file, failure) > max_bytes)
        throw Error(SourceLocation{file.string()}, "a tunnel file has at most 16 MiB");
    std::ifstream in(file, std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(in), {});
    if (!in.good() && !in.eof()) throw Error(SourceLocation{file.string()}, "this tunnel file cannot be read");
    return parse_tunnel(text, file);
}

}  // namespace kolize::tunnel
