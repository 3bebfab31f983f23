#include "boxes.h"

#include <algorithm>
#include <iomanip>
#include <random>
#include <sstream>
#include <utility>

namespace kolize {

namespace {

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    // Not std::uniform_real_distribution, whose numbers differ between standard libraries.
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    Vec3 point(double side) { return {between(0, side), between(0, side), between(0, side)}; }

private:
    std::mt19937_64 engine_;
};

constexpr std::size_t usual_count = 250;

double side_for(std::size_t count) { return std::cbrt(4.0 * static_cast<double>(count)); }

template <class Make>
BoxScene make_boxes(std::size_t count, Make&& make) {
    BoxScene scene;
    for (std::size_t row = 0; row < count; ++row) scene.bounds.push_back(make(row));
    scene.is_static.assign(count, 0);
    return scene;
}

Aabb box_at(const Vec3& corner, const Vec3& size) { return {corner, corner + size}; }

BoxScene uniform(std::uint64_t seed) { return uniform_boxes(usual_count, seed); }

BoxScene clustered(std::uint64_t seed) {
    Random random(seed);
    const std::vector<Vec3> centers{random.point(1000), random.point(1000), random.point(1000), random.point(1000)};
    return make_boxes(usual_count, [&](std::size_t row) {
        return box_at(centers[row % centers.size()] + random.point(4), Vec3::Ones());
    });
}

BoxScene six_decades(std::uint64_t seed) {
    Random random(seed);
    return make_boxes(usual_count, [&](std::size_t) {
        const auto size = [&] { return std::pow(10, random.between(-3, 3)); };
        return box_at(random.point(1000), {size(), size(), size()});
    });
}

// Twice as large is a quarter as often.
BoxScene power_law(std::uint64_t seed) {
    Random random(seed);
    return make_boxes(usual_count, [&](std::size_t) {
        const double size = std::min(1e3, 1e-3 / std::sqrt(random.between(1e-12, 1)));
        return box_at(random.point(0.02), {size, size, size});
    });
}

BoxScene all_static(std::uint64_t seed) {
    BoxScene scene = uniform_boxes(usual_count, seed);
    scene.is_static.assign(scene.is_static.size(), 1);
    return scene;
}

BoxScene mostly_static(std::uint64_t seed) {
    BoxScene scene = uniform_boxes(usual_count, seed);
    for (std::size_t row = 0; row < scene.is_static.size(); ++row) scene.is_static[row] = row % 10 != 3;
    return scene;
}

BoxScene all_overlapping(std::uint64_t seed) {
    Random random(seed);
    return make_boxes(60, [&](std::size_t) { return Aabb{-random.point(5), random.point(5)}; });
}

BoxScene coincident(std::uint64_t seed) {
    Random random(seed);
    const Vec3 corner = random.point(10);
    return make_boxes(40, [&](std::size_t) { return box_at(corner, Vec3(1, 2, 3)); });
}

// Every box of a lattice touches its 26 neighbours in a face, an edge or a corner. A third is exact in no base 2
// number: neighbours still share the very same coordinate.
BoxScene touching(std::uint64_t) {
    const auto line = [](std::size_t i) { return static_cast<double>(i) / 3; };
    return make_boxes(216, [&](std::size_t row) {
        const std::size_t x = row % 6, y = row / 6 % 6, z = row / 36;
        return Aabb{{line(x), line(y), line(z)}, {line(x + 1), line(y + 1), line(z + 1)}};
    });
}

// The same lattice with every face moved to a neighbouring number, or left: boxes touch, overlap or are apart by a unit
// in the last place.
BoxScene nearly_touching(std::uint64_t seed) {
    Random random(seed);
    BoxScene scene = touching(seed);
    for (Aabb& box : scene.bounds)
        for (int axis = 0; axis < 3; ++axis)
            for (double* x : {&box.min[axis], &box.max[axis]})
                if (const double way = random.between(-1, 1); std::abs(way) > 0.3)
                    *x = std::nextafter(*x, way > 0 ? 1e9 : -1e9);
    return scene;
}

BoxScene flat(std::uint64_t seed) {
    Random random(seed);
    return make_boxes(usual_count, [&](std::size_t row) {
        Vec3 size = 3 * Vec3::Ones(), corner = random.point(6);
        for (int axis = 0; axis < 3; ++axis)
            if (row >> axis & 1) {
                size[axis] = 0;
                corner[axis] = std::floor(corner[axis]);  // or flat boxes would hardly ever meet
            }
        return box_at(corner, size);
    });
}

BoxScene shifted(BoxScene scene, const Vec3& by) {
    for (Aabb& box : scene.bounds) box = {box.min + by, box.max + by};
    return scene;
}

BoxScene far_away(std::uint64_t seed) { return shifted(uniform_boxes(usual_count, seed), {1e12, -1e12, 1e12}); }

BoxScene one_far_away(std::uint64_t seed) {
    BoxScene scene = uniform_boxes(usual_count, seed);
    scene.bounds[7] = box_at(Vec3::Constant(-1e12), Vec3::Ones());
    return scene;
}

BoxScene one_huge(std::uint64_t seed) {
    BoxScene scene = uniform_boxes(usual_count, seed);
    scene.bounds[5] = {Vec3::Constant(-1e9), Vec3::Constant(1e9)};
    return scene;
}

// Sums and differences of these coordinates overflow, and squares do long before.
BoxScene largest_numbers(std::uint64_t seed) {
    Random random(seed);
    constexpr double most = std::numeric_limits<double>::max();
    BoxScene scene = make_boxes(60, [&](std::size_t row) {
        const Vec3 corner = most * (random.point(1) - random.point(1));
        return Aabb{corner, corner + (row % 2 ? 0.2 : 1e-200) * (Vec3::Constant(most) - corner.cwiseAbs())};
    });
    scene.bounds[0] = {Vec3::Constant(-most), Vec3::Constant(most)};
    return scene;
}

BoxScene smallest_numbers(std::uint64_t seed) {
    BoxScene scene = uniform_boxes(60, seed);
    for (Aabb& box : scene.bounds) box = {box.min * 1e-310, box.max * 1e-310};
    return scene;
}

BoxScene rods(std::uint64_t seed) {
    Random random(seed);
    return make_boxes(usual_count, [&](std::size_t row) {
        Vec3 size = Vec3::Constant(0.1);
        size[row % 3] = 100;
        return box_at(random.point(30), size);
    });
}

BoxScene mirrored(std::uint64_t seed) {
    BoxScene scene = uniform_boxes(usual_count, seed);
    for (Aabb& box : scene.bounds) box = {-box.max, -box.min};
    return scene;
}

}  // namespace

std::span<const BoxSceneKind> box_scene_kinds() {
    static constexpr BoxSceneKind kinds[] = {
        {"uniform boxes", uniform},
        {"clustered boxes", clustered},
        {"sizes over six decades", six_decades},
        {"sizes after a power law", power_law},
        {"nine in ten static", mostly_static},
        {"all static", all_static},
        {"all overlapping", all_overlapping},
        {"coincident boxes", coincident},
        {"touching boxes", touching},
        {"faces a last digit apart", nearly_touching},
        {"flat boxes and points", flat},
        {"long thin boxes", rods},
        {"mirrored boxes", mirrored},
        {"1e12 m from the origin", far_away},
        {"one box 1e12 m away", one_far_away},
        {"one huge box", one_huge},
        {"largest numbers", largest_numbers},
        {"smallest numbers", smallest_numbers},
    };
    return kinds;
}

BoxScene uniform_boxes(std::size_t count, std::uint64_t seed) {
    Random random(seed);
    return make_boxes(count, [&](std::size_t) { return box_at(random.point(side_for(count)), Vec3::Ones()); });
}

void move_boxes(BoxScene& scene, std::uint64_t seed) {
    Random random(seed);
    for (std::size_t row = 0; row < scene.bounds.size(); ++row) {
        Aabb& box = scene.bounds[row];
        const Vec3 by = 0.05 * (box.max - box.min).cwiseProduct(random.point(2) - Vec3::Ones());
        if (!scene.is_static[row]) box = {box.min + by, box.max + by};
    }
}

BoxScene permute(const BoxScene& scene, const std::vector<std::uint32_t>& order) {
    BoxScene result;
    for (const std::uint32_t row : order) {
        result.bounds.push_back(scene.bounds[row]);
        result.is_static.push_back(scene.is_static[row]);
        if (!scene.is_reference.empty()) result.is_reference.push_back(scene.is_reference[row]);
    }
    return result;
}

std::vector<Pair> overlapping_pairs(const BoxScene& scene) {
    std::vector<Pair> pairs;
    for (std::uint32_t a = 0; a < scene.bounds.size(); ++a)
        for (std::uint32_t b = a + 1; b < scene.bounds.size(); ++b)
            if (scene.bounds[a].overlaps(scene.bounds[b]) && !(scene.is_static[a] && scene.is_static[b]))
                pairs.push_back({a, b});
    return pairs;
}

namespace {

std::string to_text(const Pair& pair) {
    std::string text = "(";  // appended to: g++ 12 warns of "(" + std::string without cause
    return text.append(std::to_string(pair.a)).append(", ").append(std::to_string(pair.b)).append(")");
}

}  // namespace

std::string fault(const BoxScene& scene, std::vector<Pair> pairs) {
    std::sort(pairs.begin(), pairs.end());
    for (const Pair& pair : pairs) {
        if (pair.a >= pair.b) return "pair " + to_text(pair) + " is not in order a < b";
        if (pair.b >= scene.bounds.size()) return "pair " + to_text(pair) + " names a row that does not exist";
        if (scene.is_static[pair.a] && scene.is_static[pair.b])
            return "pair " + to_text(pair) + " is of two static rows";
    }
    if (const auto twice = std::adjacent_find(pairs.begin(), pairs.end()); twice != pairs.end())
        return "pair " + to_text(*twice) + " is reported twice";
    std::vector<Pair> missing;
    const std::vector<Pair> expected = overlapping_pairs(scene);
    std::set_difference(expected.begin(), expected.end(), pairs.begin(), pairs.end(), std::back_inserter(missing));
    return missing.empty() ? "" : "pair " + to_text(missing.front()) + " overlaps and is missing";
}

std::string inexact(const BoxScene& scene, std::vector<Pair> pairs) {
    for (const Pair& pair : pairs)
        if (!scene.bounds[pair.a].overlaps(scene.bounds[pair.b]))
            return "it declares itself exact, and the boxes of pair " + to_text(pair) + " are apart";
    return "";
}

std::string to_code(const BoxScene& scene) {
    std::ostringstream code;
    code << std::setprecision(17) << "const std::vector<Aabb> bounds{";
    const char* separator = "";
    for (const Aabb& box : scene.bounds) {
        code << std::exchange(separator, ", ") << "{{" << box.min.x() << ", " << box.min.y() << ", " << box.min.z()
             << "}, {" << box.max.x() << ", " << box.max.y() << ", " << box.max.z() << "}}";
    }
    code << "}; const std::vector<std::uint8_t> is_static{";
    separator = "";
    for (const std::uint8_t flag : scene.is_static) code << std::exchange(separator, ", ") << int(flag);
    code << "};";
    return code.str();
}

}  // namespace kolize
