// Extrusion (6.18): a cross-section that is swept along a spine.
#include "mesh_io/polygon.h"
#include "mesh_io/vrml_drawing.h"
#include "mesh_io/vrml_parser.h"
#include "mesh_io/vrml_spine.h"

#include <numeric>

namespace kolize::mesh_io::vrml {

namespace {

using Vec2 = Eigen::Vector2d;

// Closed if the cross-section is, both caps are there and no end is thinner than a line. Where a closed spine comes
// back to its begin with the scale and orientation that it left with, the surface closes there without caps: those that
// the standard asks for would be two sheets in one place that cancel.
class Extrusion : public GeneratedGeometry {
public:
    void read(Parser& parser) override;

private:
    Surface surface() const override;

    void require_sizes(Parser& parser) const;
    void cut_cap(Parser& parser, bool convex);
    bool closed_section() const { return section_.size() > 2 && section_.front() == section_.back(); }
    bool returns() const;
    // Points of the cross-section at each point of the spine.
    std::size_t section_points() const { return section_.size() - (closed_section() ? 1 : 0); }
    void add_section(Surface& surface, std::size_t i, const Mat3& frame) const;
    void add_sides(Surface& surface) const;
    void add_caps(Surface& surface) const;

    std::vector<Vec2> section_{{1, 1}, {1, -1}, {-1, -1}, {-1, 1}, {1, 1}};  // x and z
    std::vector<Vec3> spine_{{0, 0, 0}, {0, 1, 0}};
    std::vector<Vec2> scale_{{1, 1}};
    std::vector<Mat3> orientation_{Mat3::Identity()};
    bool begin_cap_ = true, end_cap_ = true, counter_clockwise_ = true;
    std::vector<Triangle> cap_;  // of the points of the cross-section
};

template <class Value>
const Value& at(const std::vector<Value>& values, std::size_t i) {
    return values[std::min(i, values.size() - 1)];
}

template <class Value, class Read>
void replace(ValueReader& values, std::vector<Value>& list, Read read) {
    list.clear();
    values.list([&] { list.push_back(read()); });
}

void Extrusion::read(Parser& parser) {
    ValueReader& values = parser.values;
    bool convex = true;
    for (std::string_view field; values.next_field(field);) {
        if (field == "crossSection")
            replace(values, section_, [&] { return values.vector2(); });
        else if (field == "spine")
            replace(values, spine_, [&] { return values.vector3(); });
        else if (field == "scale")
            replace(values, scale_, [&] { return values.vector2(); });
        else if (field == "orientation")
            replace(values, orientation_, [&] { return values.rotation(); });
        else if (field == "beginCap")
            begin_cap_ = values.boolean();
        else if (field == "endCap")
            end_cap_ = values.boolean();
        else if (field == "ccw")
            counter_clockwise_ = values.boolean();
        else if (field == "convex")
            convex = values.boolean();
        else
            values.skip_value();
    }
    require_sizes(parser);
    cut_cap(parser, convex);
}

void Extrusion::require_sizes(Parser& parser) const {
    const auto fail = [&](const std::string& message) { parser.values.fail(type.line, "Extrusion " + message); };
    const auto require_count = [&](std::size_t count, const std::string& field) {
        if (count != 1 && count < spine_.size())
            fail("with " + std::to_string(spine_.size()) + " points of the spine has " + std::to_string(count) +
                 " values of " + field + ", but needs 1 or as many");
    };
    if (spine_.size() < 2) fail("needs a spine of 2 points or more, has " + std::to_string(spine_.size()));
    if (section_.size() < 2) fail("needs a crossSection of 2 points or more, has " + std::to_string(section_.size()));
    require_count(scale_.size(), "scale");
    require_count(orientation_.size(), "orientation");
    for (const Vec2& scale : scale_)
        if (scale.minCoeff() < 0) fail("has a negative scale");
    if (spine_.size() > max_triangles / 2 / section_.size())
        fail("has more than " + std::to_string(max_triangles) + " triangles");
}

void Extrusion::cut_cap(Parser& parser, bool convex) {
    std::vector<std::uint32_t> corners(section_points());
    if ((!begin_cap_ && !end_cap_) || corners.size() < 3) return;
    if (!convex && corners.size() > max_ear_corners)
        parser.values.fail(type.line, "a crossSection that may be concave has " + std::to_string(corners.size()) +
                                          " points; " + std::to_string(max_ear_corners) + " are the most");
    std::iota(corners.begin(), corners.end(), 0u);
    std::vector<Vec3> points;
    for (const Vec2& p : section_) points.emplace_back(p.x(), 0, p.y());
    if (convex)
        add_fan(cap_, corners);
    else
        add_ears(cap_, points, corners);
}

bool Extrusion::returns() const {
    const std::size_t last = spine_.size() - 1;
    return last > 1 && spine_[0] == spine_[last] && scale_[0] == at(scale_, last) &&
           orientation_[0] == at(orientation_, last);
}

void Extrusion::add_section(Surface& surface, std::size_t i, const Mat3& frame) const {
    const Mat3 axes = frame * at(orientation_, i);
    for (std::size_t k = 0; k < section_points(); ++k) {
        const Vec2 p = section_[k].cwiseProduct(at(scale_, i));
        surface.points.push_back(axes * Vec3(p.x(), 0, p.y()) + spine_[i]);
    }
}

Surface Extrusion::surface() const {
    Surface surface;
    const std::vector<Mat3> frames = spine_frames(spine_);
    const std::size_t sections = spine_.size() - (returns() ? 1 : 0);
    for (std::size_t i = 0; i < sections; ++i) add_section(surface, i, frames[i]);
    add_sides(surface);
    if (!returns()) add_caps(surface);
    if (!counter_clockwise_)
        for (Triangle& t : surface.triangles) std::swap(t[1], t[2]);
    return surface;
}

void Extrusion::add_sides(Surface& surface) const {
    const std::size_t n = section_points();
    const std::size_t sections = surface.points.size() / n;
    // Where the scale is zero all points of the section are one.
    const auto vertex = [&](std::size_t i, std::size_t k) {
        i %= sections;
        return static_cast<std::uint32_t>(i * n + (at(scale_, i).isZero(0) ? 0 : k % n));
    };
    for (std::size_t i = 0; i + 1 < spine_.size(); ++i)
        for (std::size_t k = 0; k + 1 < section_.size(); ++k)
            surface.add_quad(vertex(i, k), vertex(i, k + 1), vertex(i + 1, k + 1), vertex(i + 1, k));
}

// The cross-section runs counter-clockwise as seen from the end of the spine.
void Extrusion::add_caps(Surface& surface) const {
    const auto n = static_cast<std::uint32_t>(section_points());
    const auto last = static_cast<std::uint32_t>(surface.points.size()) - n;
    for (const auto& [a, b, c] : cap_) {
        if (begin_cap_ && !scale_[0].isZero(0)) surface.add_triangle(a, c, b);
        if (end_cap_ && !at(scale_, spine_.size() - 1).isZero(0)) surface.add_triangle(last + a, last + b, last + c);
    }
}

}  // namespace

std::unique_ptr<Node> new_extrusion() { return std::make_unique<Extrusion>(); }

}  // namespace kolize::mesh_io::vrml
