// A tetrahedral mesh of the cube from -1 to 1 that joins given points, and which of its tetrahedra a box overlaps.
//
// Points are inserted one by one (Bowyer, Watson): the tetrahedra around a point whose circumspheres hold it are taken
// out, and the cavity is joined to the point. Circumspheres are judged in floating point, which only decides how well
// the tetrahedra are shaped. That the mesh is one is decided exactly: what of the cavity cannot be seen from the point
// is put back, and the tetrahedra that the point lies in or on, which always can, stay out.
#pragma once

#include <kolize/predicates.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace kolize {

class TetrahedralMesh {
public:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    struct Tetrahedron {
        std::uint32_t corners[4];     // orient3d of them is positive; the first is none where there is no tetrahedron
        std::uint32_t neighbours[4];  // beyond the face opposite each corner
        Vec3 normals[4];              // of these faces, inwards
    };

    // To the nearest multiple of 2^-24, by what is lost in a sum with a large number. Of such coordinates in the cube
    // differences and the products of two of them are exact, and so are normals.
    static Vec3 snapped(const Vec3& p) {
        constexpr double large = 0x1.8p28;
        return ((p.array() + large) - large).matrix();
    }

    // The points are snapped, and lie within the cube and not on its surface.
    void build(std::span<const Vec3> points) {
        begin();
        for (const Vec3& p : points) insert(p);
        seen_.assign(tetrahedra_.size(), 0);
    }

    // One of the tetrahedra that a point of the cube lies in or on. Looks from `from` on, or from where the last one
    // was found if that is none: the nearer the sooner.
    std::uint32_t locate(const Vec3& p, std::uint32_t from = none) {
        std::uint32_t at = from == none ? latest_ : from, last = none;
        // The faces are tried in random order: in a fixed one a walk may go in circles. If it takes too long all the
        // same, every tetrahedron is looked at.
        for (std::size_t step = 0; step < tetrahedra_.size(); ++step) {
            const std::uint32_t next = towards(p, at, last);
            if (next == none) return latest_ = at;
            last = at;
            at = next;
        }
        for (at = 0; tetrahedra_[at].corners[0] == none || towards(p, at, none) != none;) ++at;
        return latest_ = at;
    }

    // Appends all tetrahedra that the box overlaps, and perhaps some more that it nearly does; false if there are more
    // than `most`. One that it overlaps is `from`. The others hang together with it by faces: along any segment within
    // the box those around one point do, and those around the next have one in common with them.
    bool find_overlapped(const Aabb& box, std::uint32_t from, std::size_t most, std::vector<std::uint32_t>& found) {
        ++search_;
        seen_[from] = search_;
        const std::size_t first = found.size();
        found.push_back(from);
        for (std::size_t i = first; i < found.size(); ++i) {
            if (found.size() - first > most) return false;
            for (const std::uint32_t next : tetrahedra_[found[i]].neighbours) {
                if (next == none || seen_[next] == search_) continue;
                seen_[next] = search_;
                if (may_overlap(next, box)) found.push_back(next);
            }
        }
        return true;
    }

    std::span<const Tetrahedron> tetrahedra() const { return tetrahedra_; }
    std::span<const Vec3> points() const { return points_; }

private:
    // Opposite each corner; seen from it, they turn as orient3d wants them.
    static constexpr int faces[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
    // Of a sum of three products, with room to spare.
    static constexpr double rounding = 1e-15;

    struct Face {
        std::uint32_t corners[3];
        std::uint32_t beyond;  // the tetrahedron on the other side
        int back;              // which of that one's faces it is
    };
    struct Edge {
        std::uint32_t low, high;          // its ends
        std::uint32_t tetrahedron, face;  // that this edge and the new point span
        friend bool operator<(const Edge& a, const Edge& b) {
            return std::tie(a.low, a.high, a.tetrahedron) < std::tie(b.low, b.high, b.tetrahedron);
        }
    };

    // Six tetrahedra around the diagonal of the cube.
    void begin() {
        static constexpr std::uint32_t around_diagonal[6][4] = {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7},
                                                                {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 6, 4, 7}};
        points_.clear();
        tetrahedra_.clear();
        free_.clear();
        in_cavity_.clear();
        for (int i = 0; i < 8; ++i) points_.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        for (const auto& corners : around_diagonal) add_tetrahedron(corners[0], corners[1], corners[2], corners[3]);
        const auto face_of = [this](std::uint32_t t, int k) {  // as a set of corners
            unsigned set = 0;
            for (const int corner : faces[k]) set |= 1u << tetrahedra_[t].corners[corner];
            return set;
        };
        for (std::uint32_t t = 0; t < 6; ++t)
            for (std::uint32_t u = 0; u < 6; ++u)
                for (int k = 0; k < 4; ++k)
                    for (int l = 0; l < 4; ++l)
                        if (t != u && face_of(t, k) == face_of(u, l)) tetrahedra_[t].neighbours[k] = u;
        latest_ = 0;
    }

    void insert(const Vec3& p) {
        find_cavity(p);
        shrink_cavity(p);
        fill_cavity(p);
    }

    void find_cavity(const Vec3& p) {
        cavity_.clear();
        take_out(locate(p));
        for (std::size_t i = 0; i < cavity_.size(); ++i)
            for (int k = 0; k < 4; ++k)
                if (side(cavity_[i], k, p) == 0) take_out(tetrahedra_[cavity_[i]].neighbours[k]);
        core_ = cavity_.size();
        for (std::size_t i = 0; i < cavity_.size(); ++i)
            for (const std::uint32_t next : tetrahedra_[cavity_[i]].neighbours)
                if (next != none && !in_cavity_[next] && circumsphere_holds(next, p)) take_out(next);
    }

    void take_out(std::uint32_t t) {
        if (in_cavity_[t]) return;
        in_cavity_[t] = 1;
        cavity_.push_back(t);
    }

    bool is_outside(std::uint32_t t) const { return t == none || !in_cavity_[t]; }

    // Until all of its surface is seen from the point.
    void shrink_cavity(const Vec3& p) {
        const auto hides_a_face = [&](std::uint32_t t) {
            for (int k = 0; k < 4; ++k)
                if (is_outside(tetrahedra_[t].neighbours[k]) && side(t, k, p) <= 0) return true;
            return false;
        };
        for (std::size_t before = 0; before != cavity_.size();) {
            before = cavity_.size();
            std::size_t kept = core_;
            for (std::size_t i = core_; i < before; ++i)
                if (hides_a_face(cavity_[i]))
                    in_cavity_[cavity_[i]] = 0;
                else
                    cavity_[kept++] = cavity_[i];
            cavity_.resize(kept);
        }
    }

    void fill_cavity(const Vec3& p) {
        faces_.clear();
        for (const std::uint32_t t : cavity_)
            for (int k = 0; k < 4; ++k)
                if (is_outside(tetrahedra_[t].neighbours[k])) faces_.push_back(face_to_outside(t, k));
        for (const std::uint32_t t : cavity_) {
            tetrahedra_[t].corners[0] = none;
            in_cavity_[t] = 0;
            free_.push_back(t);
        }
        const auto point = static_cast<std::uint32_t>(points_.size());
        points_.push_back(p);
        edges_.clear();
        for (const Face& face : faces_) {
            const auto [a, b, c] = face.corners;
            const std::uint32_t t = latest_ = add_tetrahedron(a, b, c, point);
            tetrahedra_[t].neighbours[3] = face.beyond;
            if (face.beyond != none) tetrahedra_[face.beyond].neighbours[face.back] = t;
            edges_.push_back({std::min(b, c), std::max(b, c), t, 0});
            edges_.push_back({std::min(c, a), std::max(c, a), t, 1});
            edges_.push_back({std::min(a, b), std::max(a, b), t, 2});
        }
        // Each edge of the surface lies between two faces of it.
        std::sort(edges_.begin(), edges_.end());
        for (std::size_t i = 0; i < edges_.size(); i += 2) {
            tetrahedra_[edges_[i].tetrahedron].neighbours[edges_[i].face] = edges_[i + 1].tetrahedron;
            tetrahedra_[edges_[i + 1].tetrahedron].neighbours[edges_[i + 1].face] = edges_[i].tetrahedron;
        }
    }

    Face face_to_outside(std::uint32_t t, int k) const {
        const Tetrahedron& inside = tetrahedra_[t];
        const std::uint32_t beyond = inside.neighbours[k];
        int back = 0;
        while (beyond != none && tetrahedra_[beyond].neighbours[back] != t) ++back;
        return {{inside.corners[faces[k][0]], inside.corners[faces[k][1]], inside.corners[faces[k][2]]}, beyond, back};
    }

    std::uint32_t add_tetrahedron(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        if (free_.empty()) {
            free_.push_back(static_cast<std::uint32_t>(tetrahedra_.size()));
            tetrahedra_.emplace_back();
            in_cavity_.push_back(0);
        }
        const std::uint32_t number = free_.back();
        free_.pop_back();
        Tetrahedron& t = tetrahedra_[number] = {{a, b, c, d}, {none, none, none, none}, {}};
        for (int k = 0; k < 4; ++k) {
            const Vec3& apex = corner(t, faces[k][0]);
            t.normals[k] = (corner(t, faces[k][1]) - apex).cross(corner(t, faces[k][2]) - apex);
        }
        return number;
    }

    const Vec3& corner(const Tetrahedron& t, int k) const { return points_[t.corners[k]]; }

    // Of the face opposite corner k: positive inside.
    int side(std::uint32_t number, int k, const Vec3& p) const {
        const Tetrahedron& t = tetrahedra_[number];
        const Vec3 seen = p - corner(t, faces[k][0]);
        const double height = t.normals[k].dot(seen);
        if (std::abs(height) > rounding * t.normals[k].cwiseAbs().dot(seen.cwiseAbs())) return height > 0 ? 1 : -1;
        return orient3d(corner(t, faces[k][0]), corner(t, faces[k][1]), corner(t, faces[k][2]), p);
    }

    // The neighbour beyond a face that has the point behind it, other than `last`, the one come from; or none.
    std::uint32_t towards(const Vec3& p, std::uint32_t t, std::uint32_t last) {
        random_ = 1664525 * random_ + 1013904223;
        for (std::uint32_t i = 0; i < 4; ++i) {
            const std::uint32_t k = (i + (random_ >> 30)) % 4, next = tetrahedra_[t].neighbours[k];
            if (next != none && next != last && side(t, static_cast<int>(k), p) < 0) return next;
        }
        return none;
    }

    bool circumsphere_holds(std::uint32_t number, const Vec3& p) const {
        const Tetrahedron& t = tetrahedra_[number];
        const Vec3 u = corner(t, 1) - corner(t, 0), v = corner(t, 2) - corner(t, 0), w = corner(t, 3) - corner(t, 0);
        const Vec3 q = p - corner(t, 0), vw = v.cross(w);
        const Vec3 diameter =  // from the first corner to the opposite point of the sphere, times the volume
            u.squaredNorm() * vw + v.squaredNorm() * w.cross(u) + w.squaredNorm() * u.cross(v);
        return q.dot(diameter) > q.squaredNorm() * u.dot(vw);
    }

    // Whether neither a face of the box nor one of the tetrahedron has all of the other behind it.
    bool may_overlap(std::uint32_t number, const Aabb& box) const {
        const Tetrahedron& t = tetrahedra_[number];
        Aabb bounds;
        for (int k = 0; k < 4; ++k) bounds.include(corner(t, k));
        if (!bounds.overlaps(box)) return false;
        for (int k = 0; k < 4; ++k) {
            const Vec3& normal = t.normals[k];
            const Vec3 innermost = (normal.array() > 0).select(box.max, box.min);
            const Vec3 seen = innermost - corner(t, faces[k][0]);
            if (normal.dot(seen) < -rounding * normal.cwiseAbs().dot(seen.cwiseAbs())) return false;
        }
        return true;
    }

    std::vector<Vec3> points_;  // the cube's corners first
    std::vector<Tetrahedron> tetrahedra_;
    std::vector<std::uint32_t> free_;  // numbers without a tetrahedron
    std::uint32_t latest_ = 0;         // where a walk begins
    std::uint32_t random_ = 1;
    std::vector<std::uint64_t> seen_;  // in which search
    std::uint64_t search_ = 0;

    std::vector<std::uint32_t> cavity_;
    std::size_t core_ = 0;  // so many of the cavity hold the point themselves
    std::vector<std::uint8_t> in_cavity_;
    std::vector<Face> faces_;
    std::vector<Edge> edges_;
};

}  // namespace kolize
