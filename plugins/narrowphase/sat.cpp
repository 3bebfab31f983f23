// Convex polyhedra by separating axes: boxes and hulls, against each other and against half-spaces.
//
// Two convex polyhedra are apart if a face of one of them, or a plane along an edge of each, separates them; otherwise
// the axis of least overlap is the contact's normal. Edges are taken only where they make a face of the difference of
// the two (their arcs on the sphere of normals cross), and only where that is clearly less deep than any face:
// manifolds of faces hold still. On a face, the other body's most opposite face is clipped by it, and what is below is
// the contact.
//
// Everything is computed in the frame of the first body; which one that is, is decided by where the two stand and not
// by their numbers. Triangles in one plane are merged into faces before the first step.
#include <kolize/narrowphase.h>
#include <kolize/plugin.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace {

using namespace kolize;

constexpr std::size_t max_chunks = 32;

struct Face {
    Vec3 normal;                      // unit, outward
    double offset = 0;                // m
    std::vector<std::uint32_t> loop;  // its corners, seen from outside counter-clockwise
};

struct Edge {
    std::uint32_t from, to;
    std::uint32_t faces[2];
};

// In the body frame, m.
struct Polyhedron {
    std::vector<Vec3> vertices;
    std::vector<Face> faces;
    std::vector<Edge> edges;

    Polyhedron() = default;
    explicit Polyhedron(const Mesh& mesh) : vertices(mesh.vertices) {
        const std::size_t count = mesh.triangles.size();
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> triangle_at;  // by half-edge
        std::vector<Vec3> normals(count);
        for (std::uint32_t t = 0; t < count; ++t) {
            const auto& c = mesh.triangles[t];
            normals[t] = (vertices[c[1]] - vertices[c[0]]).cross(vertices[c[2]] - vertices[c[0]]);
            for (int k = 0; k < 3; ++k) triangle_at[{c[k], c[(k + 1) % 3]}] = t;
        }
        constexpr double flat = 1e-9;  // sine of the angle between two triangles of a face
        std::vector<std::uint32_t> face_of(count, none), queue;
        for (std::uint32_t seed = 0; seed < count; ++seed) {
            if (face_of[seed] != none) continue;
            const auto number = static_cast<std::uint32_t>(faces.size());
            Face& face = faces.emplace_back();
            Vec3 sum = Vec3::Zero();
            face_of[seed] = number;
            queue.assign(1, seed);
            for (std::size_t i = 0; i < queue.size(); ++i) {
                sum += normals[queue[i]];
                const auto& c = mesh.triangles[queue[i]];
                for (int k = 0; k < 3; ++k) {
                    const auto next = triangle_at.find({c[(k + 1) % 3], c[k]});
                    if (next == triangle_at.end() || face_of[next->second] != none) continue;
                    const Vec3 &m = normals[seed], &n = normals[next->second];
                    if (m.dot(n) <= 0 || m.cross(n).norm() > flat * m.norm() * n.norm()) continue;
                    face_of[next->second] = number;
                    queue.push_back(next->second);
                }
            }
            face.normal = sum.normalized();
        }
        for (const auto& [half_edge, t] : triangle_at) {
            const auto other = triangle_at.find({half_edge.second, half_edge.first});
            if (other == triangle_at.end()) throw std::invalid_argument("its surface is not closed");
            if (half_edge.first < half_edge.second && face_of[t] != face_of[other->second])
                edges.push_back({half_edge.first, half_edge.second, {face_of[t], face_of[other->second]}});
        }
        for (const auto& [half_edge, t] : triangle_at)
            if (face_of[t] != face_of[triangle_at[{half_edge.second, half_edge.first}]])
                if (faces[face_of[t]].loop.empty()) walk_loop(half_edge, face_of[t], face_of, triangle_at, mesh);
        for (Face& face : faces) {
            face.offset = -infinity;
            for (const std::uint32_t v : face.loop) face.offset = std::max(face.offset, face.normal.dot(vertices[v]));
        }
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    // The border of a face, from a half-edge on it: at each corner the next one is found by turning through the face's
    // triangles.
    void walk_loop(std::pair<std::uint32_t, std::uint32_t> start, std::uint32_t face,
                   const std::vector<std::uint32_t>& face_of,
                   const std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>& triangle_at,
                   const Mesh& mesh) {
        auto edge = start;
        do {
            faces[face].loop.push_back(edge.first);
            std::pair<std::uint32_t, std::uint32_t> next = edge;
            do {
                const auto& c = mesh.triangles[triangle_at.at(next)];
                const int k = next.second == c[0] ? 0 : next.second == c[1] ? 1 : 2;
                next = {c[k], c[(k + 1) % 3]};
                if (face_of[triangle_at.at({next.second, next.first})] != face) break;
                next = {next.second, next.first};  // inside the face: on through the triangle beyond
            } while (true);
            edge = next;
        } while (edge != start && faces[face].loop.size() <= vertices.size());
    }
};

// A polyhedron where its body stands, in the frame of the first body.
struct Placed {
    const Polyhedron* shape = nullptr;
    Mat3 rotation;
    Vec3 position;
    std::vector<Vec3> vertices, normals;

    void place(const Polyhedron& polyhedron, const Mat3& r, const Vec3& p) {
        shape = &polyhedron;
        rotation = r;
        position = p;
        vertices.clear();
        normals.clear();
        for (const Vec3& v : polyhedron.vertices) vertices.push_back(p + r * v);
        for (const Face& face : polyhedron.faces) normals.push_back(r * face.normal);
    }
    const Vec3& support(const Vec3& direction) const {
        return *std::max_element(vertices.begin(), vertices.end(),
                                 [&](const Vec3& p, const Vec3& q) { return direction.dot(p) < direction.dot(q); });
    }
    double offset(std::size_t face) const { return shape->faces[face].offset + normals[face].dot(position); }
    Vec3 along(const Edge& edge) const { return vertices[edge.to] - vertices[edge.from]; }
};

struct Point {
    Vec3 place;
    double depth;
};

// Of the first body and the second one, in the first one's frame.
struct Touch {
    Vec3 normal;  // from the first to the second
    std::vector<Point> points;
};

struct Separation {
    double distance = -infinity;  // m, < 0: they overlap by that
    std::size_t a = 0, b = 0;     // face, or edges
    Vec3 normal = Vec3::Zero();   // of edges, from the first to the second
};

Separation separate_by_faces(const Placed& a, const Placed& b) {
    Separation best;
    for (std::size_t face = 0; face < a.normals.size(); ++face) {
        const double distance = a.normals[face].dot(b.support(-a.normals[face])) - a.offset(face);
        if (distance > best.distance) best = {distance, face, 0, a.normals[face]};
    }
    return best;
}

// Whether the arcs between the normals of the faces beside two edges cross: Gregorius, GDC 2013.
bool make_a_face(const Vec3& a, const Vec3& b, const Vec3& edge_a, const Vec3& c, const Vec3& d, const Vec3& edge_b) {
    const double cba = c.dot(edge_a), dba = d.dot(edge_a), adc = a.dot(edge_b), bdc = b.dot(edge_b);
    return cba * dba < 0 && adc * bdc < 0 && cba * bdc > 0;
}

Separation separate_by_edges(const Placed& a, const Placed& b) {
    Separation best;
    for (std::size_t i = 0; i < a.shape->edges.size(); ++i) {
        const Edge& x = a.shape->edges[i];
        const Vec3 along_a = a.along(x), &n0 = a.normals[x.faces[0]], &n1 = a.normals[x.faces[1]];
        for (std::size_t j = 0; j < b.shape->edges.size(); ++j) {
            const Edge& y = b.shape->edges[j];
            const Vec3 along_b = b.along(y), m0 = -b.normals[y.faces[0]], m1 = -b.normals[y.faces[1]];
            // Edges run with their first face on the left; the other body's are seen mirrored.
            if (!make_a_face(n0, n1, n1.cross(n0), m0, m1, m1.cross(m0))) continue;
            Vec3 normal = along_a.cross(along_b);
            const double length = normal.norm();
            if (length <= 1e-9 * along_a.norm() * along_b.norm()) continue;  // parallel: a face does as well
            normal /= length;
            if (normal.dot(n0 + n1) < 0) normal = -normal;
            const double distance = normal.dot(b.vertices[y.from] - a.vertices[x.from]);
            if (distance > best.distance) best = {distance, i, j, normal};
        }
    }
    return best;
}

// Up to four of the points, well spread: the deepest, the farthest from it, the farthest from their line, and the
// farthest on the other side.
void keep_four(std::vector<Point>& points, const Vec3& normal) {
    if (points.size() <= 4) return;
    const auto take = [&](std::size_t to, auto&& value) {
        const auto best = std::max_element(points.begin() + static_cast<std::ptrdiff_t>(to), points.end(),
                                           [&](const Point& p, const Point& q) { return value(p) < value(q); });
        std::swap(points[to], *best);
    };
    take(0, [](const Point& p) { return p.depth; });
    const Vec3 first = points[0].place;
    take(1, [&](const Point& p) { return (p.place - first).squaredNorm(); });
    const Vec3 side = normal.cross(points[1].place - first);
    take(2, [&](const Point& p) { return std::abs(side.dot(p.place - first)); });
    const double turn = side.dot(points[2].place - first) > 0 ? -1 : 1;
    take(3, [&](const Point& p) { return turn * side.dot(p.place - first); });
    points.resize(4);
}

class Sat final : public Narrowphase {
public:
    Detail gives() const override { return Detail::manifold; }

    void attach(Host& host) override {
        Narrowphase::attach(host);
        chunks_.resize(max_chunks);
    }

    void prepare(const World& world) override {
        polyhedra_.clear();
        for (const Shape& shape : world.shapes)
            polyhedra_.push_back(shape.mesh ? Polyhedron(*shape.mesh) : Polyhedron());
    }

    void find_contacts(const NarrowphaseInput& input, Contacts& contacts) override {
        const std::size_t count = input.pairs.size();
        const std::size_t grain = std::max<std::size_t>(16, (count + max_chunks - 1) / max_chunks);
        host().parallel_for(count, grain, [&](std::size_t number, std::size_t begin, std::size_t end) {
            Chunk& chunk = chunks_[number];
            chunk.rows.clear();
            for (std::size_t i = begin; i < end; ++i) collide(input.world, input.pairs[i], input.detail[i], chunk);
        });
        for (std::size_t number = 0; number < Host::chunk_count(count, grain); ++number)
            contacts.rows.insert(contacts.rows.end(), chunks_[number].rows.begin(), chunks_[number].rows.end());
    }

private:
    struct Chunk {
        std::vector<Contact> rows;
        Placed first, second;
        Touch touch;
        std::vector<Vec3> polygon, clipped;
    };

    void collide(const World& world, const Pair& pair, Detail detail, Chunk& chunk) const {
        for (const std::uint32_t body : {pair.a, pair.b})
            if (!world.position[body].allFinite() || !world.orientation[body].coeffs().allFinite())
                throw std::invalid_argument("body " + std::to_string(body) + " has a pose that is not finite");
        const bool swapped = goes_first(world, pair.b, pair.a);
        const std::uint32_t a = swapped ? pair.b : pair.a, b = swapped ? pair.a : pair.b;
        const Mat3 frame = world.orientation[a].toRotationMatrix();
        const Vec3 between = world.position[b] - world.position[a], position = frame.transpose() * between;
        const Mat3 rotation = (world.orientation[a].conjugate() * world.orientation[b]).toRotationMatrix();
        if (!position.allFinite()) return;  // farther apart than numbers reach
        chunk.first.place(polyhedra_[world.shape[a]], Mat3::Identity(), Vec3::Zero());
        chunk.touch.points.clear();
        if (const Shape& other = world.shape_of(b); other.kind == ShapeKind::half_space) {
            meet_half_space(rotation * other.normal, position, chunk);
        } else {
            chunk.second.place(polyhedra_[world.shape[b]], rotation, position);
            meet(chunk);
        }
        Touch& touch = chunk.touch;
        if (touch.points.empty()) return;
        if (detail == Detail::normal) keep_deepest(touch.points);
        if (detail == Detail::manifold) keep_four(touch.points, touch.normal);
        if (detail == Detail::overlap) touch.points.resize(1);
        for (const Point& point : touch.points) {
            Contact& row = chunk.rows.emplace_back();
            row.a = pair.a;
            row.b = pair.b;
            if (detail == Detail::overlap) return;
            const Vec3 normal = frame * touch.normal, from_a = frame * point.place, from_b = from_a - between;
            row.normal = swapped ? Vec3(-normal) : normal;
            row.depth = point.depth;
            row.arm_a = swapped ? from_b : from_a;
            row.arm_b = swapped ? from_a : from_b;
        }
    }

    // Decided by what does not change when the two exchange their numbers.
    static bool goes_first(const World& world, std::uint32_t x, std::uint32_t y) {
        const bool plane_x = world.shape_of(x).kind == ShapeKind::half_space;
        const bool plane_y = world.shape_of(y).kind == ShapeKind::half_space;
        if (plane_x != plane_y) return plane_y;  // a half-space comes second
        if (world.shape[x] != world.shape[y]) return world.shape[x] < world.shape[y];
        const Vec3 &p = world.position[x], &q = world.position[y];
        if (p != q) return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
        const auto &u = world.orientation[x].coeffs(), &v = world.orientation[y].coeffs();
        return std::lexicographical_compare(u.begin(), u.end(), v.begin(), v.end());
    }

    static void meet_half_space(const Vec3& outward, const Vec3& position, Chunk& chunk) {
        chunk.touch.normal = -outward;
        for (const Vec3& v : chunk.first.vertices)
            if (const double depth = outward.dot(position - v); depth > 0)
                chunk.touch.points.push_back({v + 0.5 * depth * outward, depth});
    }

    static void meet(Chunk& chunk) {
        const Placed &a = chunk.first, &b = chunk.second;
        const Separation face_a = separate_by_faces(a, b);
        if (face_a.distance >= 0) return;
        const Separation face_b = separate_by_faces(b, a);
        if (face_b.distance >= 0) return;
        const Separation edges = separate_by_edges(a, b);
        if (edges.distance >= 0) return;
        constexpr double clearly = 0.95;
        const double face = std::max(face_a.distance, face_b.distance);
        if (edges.distance > clearly * face) return meet_edges(edges, chunk);
        if (face_a.distance >= face_b.distance)
            meet_face(a, b, face_a, 1, chunk);
        else
            meet_face(b, a, face_b, -1, chunk);
    }

    static void meet_edges(const Separation& found, Chunk& chunk) {
        const Placed &a = chunk.first, &b = chunk.second;
        const Edge &x = a.shape->edges[found.a], &y = b.shape->edges[found.b];
        const Vec3 u = a.along(x), v = b.along(y), w = b.vertices[y.from] - a.vertices[x.from];
        const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), scale = uu * vv - uv * uv;
        const double s = std::clamp((vv * u.dot(w) - uv * v.dot(w)) / scale, 0.0, 1.0);
        chunk.touch.normal = found.normal;
        chunk.touch.points.push_back(
            {a.vertices[x.from] + s * u + 0.5 * found.distance * found.normal, -found.distance});
    }

    // sign: 1 where the reference face is the first body's.
    static void meet_face(const Placed& reference, const Placed& other, const Separation& found, double sign,
                          Chunk& chunk) {
        const Vec3& normal = found.normal;
        const double offset = reference.offset(found.a);
        const auto opposite =
            std::min_element(other.normals.begin(), other.normals.end(),
                             [&](const Vec3& p, const Vec3& q) { return normal.dot(p) < normal.dot(q); });
        chunk.polygon.clear();
        for (const std::uint32_t v :
             other.shape->faces[static_cast<std::size_t>(opposite - other.normals.begin())].loop)
            chunk.polygon.push_back(other.vertices[v]);
        const std::vector<std::uint32_t>& loop = reference.shape->faces[found.a].loop;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec3 &p = reference.vertices[loop[i]], &q = reference.vertices[loop[(i + 1) % loop.size()]];
            clip((q - p).cross(normal), p, chunk);
        }
        // Where the clipped face is all above, or there is none, the deepest corner.
        const Vec3& deepest = other.support(-normal);
        chunk.polygon.push_back(deepest);
        chunk.touch.normal = sign * normal;
        for (std::size_t i = 0; i < chunk.polygon.size(); ++i) {
            const Vec3& point = chunk.polygon[i];
            const double depth = offset - normal.dot(point);
            if (i + 1 == chunk.polygon.size() && !chunk.touch.points.empty()) break;
            if (depth > 0) chunk.touch.points.push_back({point + 0.5 * depth * normal, depth});
        }
    }

    // Sutherland and Hodgman (1974): what is on the inner side of a plane through a point.
    static void clip(const Vec3& outward, const Vec3& point, Chunk& chunk) {
        const std::vector<Vec3>& in = chunk.polygon;
        chunk.clipped.clear();
        for (std::size_t i = 0; i < in.size(); ++i) {
            const Vec3 &p = in[i], &q = in[(i + 1) % in.size()];
            const double hp = outward.dot(p - point), hq = outward.dot(q - point);
            if (hp <= 0) chunk.clipped.push_back(p);
            if ((hp < 0 && hq > 0) || (hp > 0 && hq < 0)) chunk.clipped.push_back(p + hp / (hp - hq) * (q - p));
        }
        chunk.polygon.swap(chunk.clipped);
    }

    // One point; where several are as deep, their mean.
    static void keep_deepest(std::vector<Point>& points) {
        double depth = 0, spread = 0;
        for (const Point& p : points) {
            depth = std::max(depth, p.depth);
            spread = std::max(spread, (p.place - points[0].place).norm());
        }
        Point mean{Vec3::Zero(), depth};
        double count = 0;
        for (const Point& p : points)
            if (p.depth >= depth - 1e-9 * (spread + depth)) mean.place += p.place, ++count;
        mean.place /= count;
        points.assign(1, mean);
    }

    std::vector<Polyhedron> polyhedra_;  // by shape of the world
    std::vector<Chunk> chunks_;          // of pairs
};

}  // namespace

KOLIZE_PLUGIN(
    Sat, .name = "sat", .summary = "boxes and convex hulls by separating axes, with clipped faces as manifolds",
    .source =
        "Gottschalk, Lin and Manocha, OBBTree, SIGGRAPH 1996; Gregorius, The separating axis test between convex "
        "polyhedra, GDC 2013; Ericson, Real-Time Collision Detection (2005), 5.2.1 and 8.3.4",
    .cost =
        "Corners times faces of the two, and the product of their edges: a microsecond or two for boxes, and with "
        "the square of the number of corners for hulls.",
    .accuracy =
        "Overlap and depth to rounding. A face is taken for the normal unless edges are less deep by a twentieth, "
        "so the depth is up to that above the least one.",
    .choose =
        "Stacks and heaps of boxes and small hulls, with whole manifolds. moller takes all shapes; gjk_epa takes "
        "round ones and hulls of many corners.",
    .capabilities = {.shape_kinds = bit(ShapeKind::box) | bit(ShapeKind::hull) | bit(ShapeKind::half_space),
                     .gives = Detail::manifold})
