// Broadphases that keep something from step to step, over sequences of steps, against brute force.
#include <catch2/catch.hpp>
#include <kolize/plugin_library.h>
#include <kolize/simulation.h>

#include <algorithm>
#include <functional>
#include <random>

using namespace kolize;

namespace {

struct Boxes {
    std::vector<Aabb> bounds;
    std::vector<std::uint8_t> is_static, is_reference;
};

// By definition.
std::vector<Pair> overlapping_pairs(const Boxes& boxes) {
    std::vector<Pair> pairs;
    for (std::uint32_t a = 0; a < boxes.bounds.size(); ++a)
        for (std::uint32_t b = a + 1; b < boxes.bounds.size(); ++b)
            if (boxes.bounds[a].overlaps(boxes.bounds[b]) && !(boxes.is_static[a] && boxes.is_static[b]))
                pairs.push_back({a, b});
    return pairs;
}

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    Vec3 point(double side) { return {between(-side, side), between(-side, side), between(-side, side)}; }
    std::size_t below(std::size_t end) { return engine_() % end; }

private:
    std::mt19937_64 engine_;
};

using MakeBox = std::function<Aabb(Random&)>;

struct Kind {
    const char* name;
    MakeBox make;
};

Aabb box_at(const Vec3& corner, const Vec3& size) { return {corner, corner + size}; }

const std::vector<Kind>& kinds() {
    static const std::vector<Kind> kinds{
        {"unit boxes", [](Random& r) { return box_at(r.point(4), Vec3::Ones()); }},
        {"sizes after a power law",
         [](Random& r) { return box_at(r.point(8), Vec3::Constant(0.2 * std::pow(1 - r.between(0, 1), -0.7))); }},
        {"one place", [](Random&) { return box_at(Vec3(1, 2, 3), Vec3::Ones()); }},
        {"points of a small lattice",
         [](Random& r) {
             return box_at(Vec3(double(r.below(4)), double(r.below(4)), double(r.below(4))), Vec3::Zero());
         }},
        {"boxes of a lattice, faces shared",
         [](Random& r) {
             return box_at(Vec3(double(r.below(6)), -double(r.below(6)), double(r.below(6))) / 3, Vec3::Ones() / 3);
         }},
        {"boxes in a plane", [](Random& r) { return box_at(r.point(6).cwiseProduct(Vec3(1, 1, 0)), Vec3(1, 0.5, 0)); }},
        {"1e12 m away", [](Random& r) { return box_at(Vec3(1e12, -1e12, 1e12) + r.point(4), Vec3::Ones()); }},
        {"1e300 m large",
         [](Random& r) { return box_at(1e300 * r.point(4), Vec3::Constant(1e300 * r.between(0, 1))); }},
        {"now large, now small",
         [](Random& r) {
             const double size = r.below(10) ? 1 : 1e300;
             return box_at(size * r.point(4), Vec3::Constant(size));
         }},
    };
    return kinds;
}

Boxes make_boxes(const Kind& kind, std::size_t count, double static_part, Random& random) {
    Boxes boxes;
    for (std::size_t row = 0; row < count; ++row) {
        boxes.bounds.push_back(kind.make(random));
        boxes.is_static.push_back(random.between(0, 1) < static_part);
        boxes.is_reference.push_back(random.below(8) == 0);
    }
    return boxes;
}

void shift(Boxes& boxes, Random& random) {
    for (std::size_t row = 0; row < boxes.bounds.size(); ++row) {
        Aabb& box = boxes.bounds[row];
        const Vec3 by = 0.1 * (box.max - box.min).cwiseProduct(random.point(1));
        if (!boxes.is_static[row]) box = {box.min + by, box.max + by};
    }
}

void teleport(Boxes& boxes, const Kind& kind, Random& random) {
    for (std::size_t row = 0; row < boxes.bounds.size(); ++row)
        if (!boxes.is_static[row]) boxes.bounds[row] = kind.make(random);
}

struct Subject {
    const char* plugin;
    std::map<std::string, Setting> settings;
};

const std::vector<Subject>& subjects() {
    static const std::vector<Subject> subjects{
        {"aabb_hierarchy", {}},
        {"aabb_hierarchy", {{"rebuild_at", {1.0, {}}}}},
        {"auto", {}},
        {"embree", {}},
        {"kd_tree", {}},
        {"kd_tree", {{"leaf_size", {std::int64_t{1}, {}}}}},
        {"octree", {}},
        {"octree", {{"looseness", {1.0, {}}}}},
        {"quadtree", {}},
        {"quadtree", {{"up", {std::string("x"), {}}}}},
        {"regions", {}},
        {"sweep_and_prune", {{"method", {std::string("scratch"), {}}}}},
        {"sweep_and_prune", {{"method", {std::string("incremental"), {}}}}},
        {"tetrahedral", {}},
        {"tetrahedral", {{"max_cells", {std::int64_t{4}, {}}}}},
        {"tetrahedral", {{"max_points", {std::int64_t{10}, {}}}}},
    };
    return subjects;
}

// Steps of small motion, at times all boxes elsewhere or others instead.
void require_right(Broadphase& stage, const Kind& kind, double static_part, Random& random) {
    std::vector<Pair> pairs;
    Boxes boxes;
    std::uint64_t generation = 0;
    for (int step = 0; step < 40; ++step) {
        if (step % 12 == 0) {
            boxes = make_boxes(kind, 20 + random.below(100), static_part, random);
            ++generation;
        } else if (step % 5 == 0) {
            teleport(boxes, kind, random);
        } else {
            shift(boxes, random);
        }
        pairs.clear();
        stage.find_pairs({boxes.bounds, boxes.is_static, generation, boxes.is_reference}, pairs);
        std::sort(pairs.begin(), pairs.end());
        CAPTURE(step);
        REQUIRE(pairs == overlapping_pairs(boxes));
    }
}

}  // namespace

TEST_CASE("broadphases with a memory find exactly the overlapping pairs over many steps", "[broadphase]") {
    const PluginLibrary library({KOLIZE_PLUGIN_DIR});
    const auto host = make_host(1);
    const std::uint64_t seed = 5;
    CAPTURE(seed);
    Random random(seed);
    for (const Subject& subject : subjects())
        for (const Kind& kind : kinds())
            for (const double static_part : {0.0, 0.5, 0.9, 1.0}) {
                const auto stage = library.make<Broadphase>({subject.plugin, {}, subject.settings}, *host);
                const std::string settings =
                    subject.settings.empty() ? "" : to_string(subject.settings.begin()->second.value);
                CAPTURE(subject.plugin, settings, kind.name, static_part);
                require_right(*stage, kind, static_part, random);
            }
}
