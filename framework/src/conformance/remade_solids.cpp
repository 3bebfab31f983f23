#include "remade_solids.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace kolize {

namespace {

TriangleSoup surface_of(const Shape& shape) {
    TriangleSoup soup;
    soup.vertices = shape.mesh->vertices;
    soup.triangles = shape.mesh->triangles;
    return soup;
}

// Gives the body a shape whose model frame is the present body frame, and leaves the solid where it is.
void replace_shape(World& world, std::uint32_t body, Shape shape) {
    world.position[body] += world.orientation[body] * shape.center_in_model;
    world.orientation[body] = (world.orientation[body] * shape.body_to_model).normalized();
    world.shapes[world.shape[body]] = std::move(shape);
}

template <class Remake>
World with_meshes(World world, Remake&& remake) {
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        const Shape& shape = world.shape_of(body);
        if (shape.kind == ShapeKind::mesh) replace_shape(world, body, make_mesh(shape.name, remake(surface_of(shape))));
    }
    return world;
}

Shape scaled(Shape shape, double by) {
    shape.radius *= by;
    shape.half_extents *= by;
    shape.cap_radius *= by;
    shape.half_height *= by;
    shape.bounds = {by * shape.bounds.min, by * shape.bounds.max};
    shape.volume *= by * by * by;
    shape.moments *= by * by;
    shape.center_in_model *= by;
    if (!shape.mesh) return shape;
    TriangleSoup soup = surface_of(shape);
    for (Vec3& v : soup.vertices) v *= by;
    shape.mesh = build_mesh(soup, shape.mesh->closed);
    return shape;
}

Vec3 mirrored(const Vec3& v) { return {-v.x(), v.y(), v.z()}; }

// Spheres, boxes and capsules are their own images.
Shape mirrored(const Shape& shape) {
    if (shape.kind == ShapeKind::half_space) {
        Shape image = shape;
        image.normal = mirrored(shape.normal);
        return image;
    }
    if (shape.kind != ShapeKind::mesh && shape.kind != ShapeKind::hull) return shape;
    TriangleSoup soup = surface_of(shape);
    for (Vec3& v : soup.vertices) v = mirrored(v);
    for (Triangle& t : soup.triangles) std::swap(t[1], t[2]);
    return shape.kind == ShapeKind::mesh ? make_mesh(shape.name, soup) : make_hull(shape.name, soup.vertices);
}

TriangleSoup renumbered(TriangleSoup soup, std::mt19937_64& random) {
    std::vector<std::uint32_t> number(soup.vertices.size());
    std::iota(number.begin(), number.end(), 0u);
    std::shuffle(number.begin(), number.end(), random);
    const std::vector<Vec3> vertices = soup.vertices;
    for (std::size_t i = 0; i < vertices.size(); ++i) soup.vertices[number[i]] = vertices[i];
    for (Triangle& t : soup.triangles) {
        for (std::uint32_t& vertex : t) vertex = number[vertex];
        std::rotate(t.begin(), t.begin() + random() % 3, t.end());
    }
    std::shuffle(soup.triangles.begin(), soup.triangles.end(), random);
    return soup;
}

TriangleSoup subdivided(const TriangleSoup& soup) {
    TriangleSoup fine;
    fine.vertices = soup.vertices;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [found, is_new] =
            middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(fine.vertices.size()));
        if (is_new) fine.vertices.push_back((soup.vertices[a] + soup.vertices[b]) / 2);
        return found->second;
    };
    for (const Triangle& t : soup.triangles) {
        const std::uint32_t m[3] = {middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])};
        for (const Triangle& part : {Triangle{t[0], m[0], m[2]}, Triangle{t[1], m[1], m[0]}, Triangle{t[2], m[2], m[1]},
                                     Triangle{m[0], m[1], m[2]}})
            fine.triangles.push_back(part);
    }
    return fine;
}

}  // namespace

World scaled(const World& world, double power_of_two) {
    World other = world;
    for (Vec3& p : other.position) p *= power_of_two;
    for (Shape& shape : other.shapes) shape = scaled(shape, power_of_two);
    return other;
}

World mirrored(const World& world) {
    World other = world;
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        const Quat& q = world.orientation[body];
        other.position[body] = mirrored(world.position[body]);
        other.orientation[body] = Quat(q.w(), q.x(), -q.y(), -q.z());
        const Shape& shape = world.shape_of(body);
        if (shape.kind == ShapeKind::mesh || shape.kind == ShapeKind::hull)
            replace_shape(other, body, mirrored(shape));
        else
            other.shapes[other.shape[body]] = mirrored(shape);
    }
    return other;
}

World renumbered_meshes(const World& world, std::mt19937_64& random) {
    return with_meshes(world, [&](const TriangleSoup& soup) { return renumbered(soup, random); });
}

World subdivided_meshes(const World& world) { return with_meshes(world, subdivided); }

}  // namespace kolize
