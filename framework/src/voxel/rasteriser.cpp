#include <kolize/voxel_mass_properties.h>

namespace kolize {

namespace {

// A vertex as the lines see it: across them in units of their spacing, so that line i of row j stands at (i, j).
struct GridPoint {
    double column, row;
    double depth;  // m
};

// Rounds up; x is within the range of int. Faster than std::ceil where the processor has no instruction for it.
std::int32_t round_up(double x) {
    const auto whole = static_cast<std::int32_t>(x);
    return whole + (x > whole);
}

// By value, unlike std::clamp: two instructions. What is not a number becomes `low`.
double clamped(double x, double low, double high) {
    x = x > low ? x : low;
    return x < high ? x : high;
}

// The surface along one axis, and the triangles of each band.
class Rasteriser : public LineCaster {
public:
    Rasteriser(const TriangleSoup& surface, const GridLines& lines) : surface(surface), lines(lines) {
        const Scale column{lines.columns.front(), 1 / lines.column_spacing, static_cast<double>(lines.columns.size())};
        const Scale row{lines.rows.front(), 1 / lines.row_spacing, static_cast<double>(lines.rows.size())};
        points.reserve(surface.vertices.size());
        first_row.reserve(surface.vertices.size());
        for (const Vec3& p : surface.vertices) {
            points.push_back({column(p[lines.column_axis]), row(p[lines.row_axis]), p[lines.axis]});
            first_row.push_back(round_up(points.back().row));
        }
        sort_into_bands();
    }
    std::unique_ptr<LineScan> start() const override;

    const TriangleSoup& surface;
    const GridLines& lines;
    std::vector<GridPoint> points;           // per vertex
    std::vector<std::int32_t> first_row;     // per vertex: that is not below it; the number of rows if there is none
    std::vector<std::uint32_t> triangles;    // by band; one that meets several bands stands in each
    std::vector<std::size_t> band_begin{0};  // per band, and the end of the last one

private:
    // Vertices that no triangle uses may lie anywhere: they are kept near the lines, whose numbers are integers.
    struct Scale {
        double first, per_unit, count;
        double operator()(double x) const { return clamped((x - first) * per_unit, -1, count); }
    };

    // A triangle meets the rows from its lowest vertex up to, but without, its highest.
    template <class Visit>
    void for_each_band(const Visit& visit) const {
        const auto height = static_cast<std::int32_t>(lines.rows_per_band);
        for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
            const auto& [a, b, c] = surface.triangles[t];
            const auto [low, high] = std::minmax({first_row[a], first_row[b], first_row[c]});
            if (low == high) continue;
            for (std::int32_t band = low / height; band <= (high - 1) / height; ++band)
                visit(static_cast<std::size_t>(band), t);
        }
    }

    void sort_into_bands() {
        band_begin.assign(lines.bands() + 1, 0);
        for_each_band([&](std::size_t band, std::uint32_t) { ++band_begin[band + 1]; });
        for (std::size_t band = 0; band < lines.bands(); ++band) band_begin[band + 1] += band_begin[band];
        triangles.resize(band_begin.back());
        std::vector<std::size_t> next = band_begin;
        for_each_band([&](std::size_t band, std::uint32_t t) { triangles[next[band]++] = t; });
    }
};

// From the vertex on the lower row to the other one, in both triangles of the edge: the same numbers for both.
class EdgeWalk {
public:
    EdgeWalk(const GridPoint& low, const GridPoint& high)
        : low_(low),
          columns_(high.column - low.column),
          depths_(high.depth - low.depth),
          per_row_(1 / (high.row - low.row)) {}

    double part_at(double row) const { return clamped((row - low_.row) * per_row_, 0, 1); }
    double column(double part) const { return low_.column + part * columns_; }
    double depth(double part) const { return low_.depth + part * depths_; }

private:
    GridPoint low_;
    double columns_, depths_, per_row_;
};

// The plane of a triangle, within the depths of its corners: where it stands nearly along the lines, its slope says
// little.
struct Facet {
    Facet(const GridPoint& p, const GridPoint& q, const GridPoint& r) {
        const double columns[2] = {q.column - p.column, r.column - p.column};
        const double rows[2] = {q.row - p.row, r.row - p.row};
        const double depths[2] = {q.depth - p.depth, r.depth - p.depth};
        slope = (depths[0] * rows[1] - depths[1] * rows[0]) / (columns[0] * rows[1] - columns[1] * rows[0]);
        low = std::min({p.depth, q.depth, r.depth});
        high = std::max({p.depth, q.depth, r.depth});
    }
    double slope;  // of the depth from column to column
    double low, high;
};

class RasteriserScan : public LineScan {
public:
    explicit RasteriserScan(const Rasteriser& caster)
        : caster_(caster), columns_(static_cast<std::int32_t>(caster.lines.columns.size())) {}

    const LineCrossings& cast(std::size_t band) override {
        begin_row_ = static_cast<std::int32_t>(caster_.lines.first_row(band));
        end_row_ = static_cast<std::int32_t>(caster_.lines.last_row(band));
        used_ = 0;
        for (std::size_t i = caster_.band_begin[band]; i < caster_.band_begin[band + 1]; ++i)
            add_triangle(caster_.surface.triangles[caster_.triangles[i]]);
        sort_hits({hits_.data(), used_}, static_cast<std::size_t>((end_row_ - begin_row_) * columns_), out_);
        return out_;
    }

private:
    // The edge from the lowest row to the highest is the long one; the other two take turns beside it.
    void add_triangle(Triangle t) {
        const std::vector<std::int32_t>& first_row = caster_.first_row;
        bool long_edge_up = false;  // in the sense in which the triangle runs through it
        // Without branches: small triangles come in every order.
        const auto order = [&](int i, int j) {
            const bool swap = first_row[t[i]] > first_row[t[j]];
            const std::uint32_t low = t[swap ? j : i], high = t[swap ? i : j];
            t[i] = low;
            t[j] = high;
            long_edge_up ^= swap;
        };
        order(0, 1);
        order(1, 2);
        order(0, 1);
        const GridPoint &low = caster_.points[t[0]], &middle = caster_.points[t[1]], &high = caster_.points[t[2]];
        const EdgeWalk long_edge(low, high);
        const std::int32_t begin = std::max(first_row[t[0]], begin_row_), end = std::min(first_row[t[2]], end_row_);
        const std::int32_t turn = std::clamp(first_row[t[1]], begin, end);
        const Facet facet(low, middle, high);
        if (begin < turn) add_rows(begin, turn, long_edge, {low, middle}, long_edge_up, facet);
        if (turn < end) add_rows(turn, end, long_edge, {middle, high}, long_edge_up, facet);
    }

    // Seen against the lines, a triangle that faces their ends runs up on the right.
    void add_rows(std::int32_t begin, std::int32_t end, const EdgeWalk& long_edge, const EdgeWalk& short_edge,
                  bool long_edge_up, const Facet& facet) {
        for (std::int32_t row = begin; row < end; ++row) {
            const double part = long_edge.part_at(row), from = long_edge.column(part);
            const std::int32_t i = round_up(from), j = round_up(short_edge.column(short_edge.part_at(row)));
            const std::int32_t first = i < j ? i : j, count = i < j ? j - i : i - j;
            const double depth = long_edge.depth(part) + (first - from) * facet.slope;
            add_hits((row - begin_row_) * columns_ + first, count, depth, facet, (i < j) == long_edge_up ? 1 : -1);
        }
    }

    // A few hits are always written, as many as suit a small triangle's row; what is too much is written over by the
    // next row. A loop of just the right length would cost a mispredicted branch a row.
    void add_hits(std::int32_t line, std::int32_t count, double depth, const Facet& facet, int sign) {
        constexpr std::int32_t always = 3;
        LineHit* const hits = room_for(static_cast<std::size_t>(count > always ? count : always));
        const auto write = [&](std::int32_t k) {
            hits[k] = {clamped(depth + k * facet.slope, facet.low, facet.high), static_cast<std::uint32_t>(line + k),
                       sign};
        };
        for (std::int32_t k = 0; k < always; ++k) write(k);
        for (std::int32_t k = always; k < count; ++k) write(k);
        used_ += static_cast<std::size_t>(count);
    }

    LineHit* room_for(std::size_t count) {
        if (hits_.size() < used_ + count) hits_.resize(2 * (used_ + count));
        return &hits_[used_];
    }

    const Rasteriser& caster_;
    const std::int32_t columns_;
    std::int32_t begin_row_ = 0, end_row_ = 0;
    std::vector<LineHit> hits_;
    std::size_t used_ = 0;  // of them
    LineCrossings out_;
};

std::unique_ptr<LineScan> Rasteriser::start() const { return std::make_unique<RasteriserScan>(*this); }

}  // namespace

std::unique_ptr<LineCaster> make_line_rasteriser(const TriangleSoup& surface, const GridLines& lines) {
    return std::make_unique<Rasteriser>(surface, lines);
}

}  // namespace kolize
