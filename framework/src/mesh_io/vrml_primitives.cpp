// Box, Cone, Cylinder and Sphere (6.7, 6.11, 6.14, 6.43) as closed polyhedra with shared vertices. Round ones are
// inscribed: their vertices lie on the true surface.
#include "mesh_io/vrml_parser.h"

#include <numbers>

namespace kolize::mesh_io::vrml {

namespace {

constexpr std::uint32_t sides = 64;   // around the y axis
constexpr std::uint32_t layers = 32;  // of a sphere, from pole to pole

void note_polyhedron(Parser& parser, const Token& type) {
    parser.values.notes.add(
        std::string(type.text) + " stands for an inscribed polyhedron, " + std::to_string(sides) + " sides around",
        type.line);
}

// A circle about the y axis, counter-clockwise seen from above; the number of its first point.
std::uint32_t add_circle(Surface& surface, double radius, double y) {
    const auto first = static_cast<std::uint32_t>(surface.points.size());
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        surface.points.emplace_back(radius * std::sin(angle), y, radius * std::cos(angle));
    }
    return first;
}

std::uint32_t add_point(Surface& surface, double y) {
    surface.points.emplace_back(0, y, 0);
    return static_cast<std::uint32_t>(surface.points.size() - 1);
}

void add_band(Surface& surface, std::uint32_t lower, std::uint32_t upper) {
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t next = (i + 1) % sides;
        surface.add_quad(lower + i, lower + next, upper + next, upper + i);
    }
}

// Triangles from a circle to a point above it, on the axis or in its plane; or to one below.
void add_fan_up(Surface& surface, std::uint32_t circle, std::uint32_t top) {
    for (std::uint32_t i = 0; i < sides; ++i) surface.add_triangle(circle + i, circle + (i + 1) % sides, top);
}

void add_fan_down(Surface& surface, std::uint32_t circle, std::uint32_t bottom) {
    for (std::uint32_t i = 0; i < sides; ++i) surface.add_triangle(circle + (i + 1) % sides, circle + i, bottom);
}

class Box : public GeneratedGeometry {
public:
    void read(Parser& parser) override {
        for (std::string_view field; parser.values.next_field(field);) {
            if (field == "size")
                for (double& side : size_) side = parser.values.positive_number();
            else
                parser.values.skip_value();
        }
    }

private:
    Surface surface() const override {
        TriangleSoup box = box_soup(0.5 * size_);
        return {std::move(box.vertices), std::move(box.triangles)};
    }

    Vec3 size_ = Vec3::Constant(2);
};

class Sphere : public GeneratedGeometry {
public:
    void read(Parser& parser) override {
        for (std::string_view field; parser.values.next_field(field);) {
            if (field == "radius")
                radius_ = parser.values.positive_number();
            else
                parser.values.skip_value();
        }
        note_polyhedron(parser, type);
    }

private:
    Surface surface() const override {
        Surface sphere;
        std::uint32_t lower = 0;
        for (std::uint32_t layer = 1; layer < layers; ++layer) {
            const double angle = std::numbers::pi * layer / layers;  // from the south pole
            const std::uint32_t upper = add_circle(sphere, radius_ * std::sin(angle), -radius_ * std::cos(angle));
            if (layer > 1) add_band(sphere, lower, upper);
            lower = upper;
        }
        add_fan_up(sphere, lower, add_point(sphere, radius_));
        add_fan_down(sphere, 0, add_point(sphere, -radius_));
        return sphere;
    }

    double radius_ = 1;
};

class Cone : public GeneratedGeometry {
public:
    void read(Parser& parser) override {
        for (std::string_view field; parser.values.next_field(field);) {
            if (field == "bottomRadius")
                radius_ = parser.values.positive_number();
            else if (field == "height")
                height_ = parser.values.positive_number();
            else if (field == "side")
                side_ = parser.values.boolean();
            else if (field == "bottom")
                bottom_ = parser.values.boolean();
            else
                parser.values.skip_value();
        }
        note_polyhedron(parser, type);
    }

private:
    Surface surface() const override {
        Surface cone;
        const std::uint32_t circle = add_circle(cone, radius_, -0.5 * height_);
        if (side_) add_fan_up(cone, circle, add_point(cone, 0.5 * height_));
        if (bottom_) add_fan_down(cone, circle, add_point(cone, -0.5 * height_));
        return cone;
    }

    double radius_ = 1, height_ = 2;
    bool side_ = true, bottom_ = true;
};

class Cylinder : public GeneratedGeometry {
public:
    void read(Parser& parser) override {
        for (std::string_view field; parser.values.next_field(field);) {
            if (field == "radius")
                radius_ = parser.values.positive_number();
            else if (field == "height")
                height_ = parser.values.positive_number();
            else if (field == "side")
                side_ = parser.values.boolean();
            else if (field == "top")
                top_ = parser.values.boolean();
            else if (field == "bottom")
                bottom_ = parser.values.boolean();
            else
                parser.values.skip_value();
        }
        note_polyhedron(parser, type);
    }

private:
    Surface surface() const override {
        Surface cylinder;
        const std::uint32_t lower = add_circle(cylinder, radius_, -0.5 * height_);
        const std::uint32_t upper = add_circle(cylinder, radius_, 0.5 * height_);
        if (side_) add_band(cylinder, lower, upper);
        if (top_) add_fan_up(cylinder, upper, add_point(cylinder, 0.5 * height_));
        if (bottom_) add_fan_down(cylinder, lower, add_point(cylinder, -0.5 * height_));
        return cylinder;
    }

    double radius_ = 1, height_ = 2;
    bool side_ = true, top_ = true, bottom_ = true;
};

}  // namespace

std::unique_ptr<Node> new_box() { return std::make_unique<Box>(); }
std::unique_ptr<Node> new_sphere() { return std::make_unique<Sphere>(); }
std::unique_ptr<Node> new_cone() { return std::make_unique<Cone>(); }
std::unique_ptr<Node> new_cylinder() { return std::make_unique<Cylinder>(); }

}  // namespace kolize::mesh_io::vrml
