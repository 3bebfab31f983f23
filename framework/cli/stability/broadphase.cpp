// Broadphases: sizes, distance, motion and crowds, against every box with every other.
#include "stability/study.h"

#include <kolize/broadphase.h>

#include <algorithm>

namespace kolize::cli::stability {
namespace {

constexpr int rounds = 3;  // of random boxes at each point
constexpr int steps = 3;

enum { size_ratio, distance, motion, crowd };

// A quarter of the boxes stands still. Every second box begins where the one before it ends, in one axis, or a little
// before or after: those are the pairs that rounding decides.
struct Boxes {
    std::vector<Aabb> bounds;
    std::vector<std::uint8_t> is_static;

    void add(const Vec3& corner, const Vec3& size) {
        is_static.push_back(bounds.size() % 4 == 3);
        bounds.push_back({corner, corner + size});
    }
};

Vec3 beside(const Aabb& box, const Vec3& size, Dice& dice) {
    const Vec3 extent = box.max - box.min;
    Vec3 corner = box.min + dice.between(-0.5, 0.5) * extent.cwiseMin(size);
    const int axis = dice.below(3);
    const double gaps[] = {-1e-3 * size[axis], 0, 1e-3 * size[axis]};
    corner[axis] = box.max[axis] + gaps[dice.below(3)];
    return corner;
}

Boxes make_boxes(const Point& point, Dice& dice) {
    Boxes boxes;
    const double decades = point[size_ratio];
    const int in_crowd = static_cast<int>(std::lround(value(point, crowd)));
    const double side = 5 * std::pow(10, decades);
    for (int i = 0; i < 120; ++i) {
        const auto length = [&] { return std::pow(10, dice.between(0, decades)) * dice.between(0.5, 1); };
        const double x = length(), y = length(), z = length();
        const Vec3 size(x, y, z);
        boxes.add(i % 2 ? beside(boxes.bounds.back(), size, dice) : dice.point(side), size);
    }
    for (int i = 0; i < in_crowd; ++i) boxes.add(-Vec3::Ones() - dice.point(0.5), 2 * Vec3::Ones() + dice.point(0.5));
    const Vec3 shift = value(point, distance) * dice.direction();
    for (Aabb& box : boxes.bounds) box = {box.min + shift, box.max + shift};
    return boxes;
}

void move(Boxes& boxes, double by, Dice& dice) {
    for (std::size_t row = 0; row < boxes.bounds.size(); ++row) {
        Aabb& box = boxes.bounds[row];
        const Vec3 step = by * (box.max - box.min).norm() * dice.direction();
        if (!boxes.is_static[row]) box = {box.min + step, box.max + step};
    }
}

std::string text(const Pair& pair) { return std::to_string(pair.a) + " and " + std::to_string(pair.b); }

Outcome judge(const Boxes& boxes, std::vector<Pair> found, bool exact) {
    std::sort(found.begin(), found.end());
    if (const auto twice = std::adjacent_find(found.begin(), found.end()); twice != found.end())
        return {Failure::wrong, "boxes " + text(*twice) + " are reported twice"};
    const std::size_t count = boxes.bounds.size();
    auto next = found.begin();
    for (std::uint32_t a = 0; a < count; ++a)
        for (std::uint32_t b = a + 1; b < count; ++b) {
            const bool reported = next != found.end() && *next == Pair{a, b};
            const bool both_static = boxes.is_static[a] && boxes.is_static[b];
            const bool overlap = boxes.bounds[a].overlaps(boxes.bounds[b]);
            if (overlap && !both_static && !reported)
                return {Failure::missed, "boxes " + text({a, b}) + " overlap and are not reported"};
            if (reported && both_static) return {Failure::wrong, "two static boxes are reported"};
            if (reported && !overlap && exact)
                return {Failure::wrong, "boxes " + text({a, b}) + " are apart and are reported"};
            next += reported;
        }
    if (next != found.end()) return {Failure::wrong, "a pair is reported that there is not"};
    return {};
}

Outcome probe(const Context& context, const Subject& subject, const Point& point) {
    for (int round = 0; round < rounds; ++round) {
        Dice dice(context.seed + static_cast<unsigned>(round));
        Boxes boxes = make_boxes(point, dice);
        const auto stage = context.plugins.make<Broadphase>(subject.config, context.host);
        for (int step = 0; step < steps; ++step) {
            std::vector<Pair> pairs;
            stage->find_pairs({boxes.bounds, boxes.is_static, 1}, pairs);
            const Outcome outcome = judge(boxes, std::move(pairs), subject.plugin->descriptor->capabilities.exact);
            if (!outcome.holds()) return outcome;
            move(boxes, value(point, motion), dice);
        }
    }
    return {};
}

}  // namespace

std::vector<Study> broadphase_studies(const Context& context, const std::vector<Subject>& subjects) {
    return {
        {"broadphase",
         "pairs",
         "120 boxes, three steps: every pair of boxes that overlap, as rounded, has to be reported, and of a plugin "
         "that is exact no other. Oracle: every box against every other.",
         {{"size_ratio", "", "the largest box over the smallest", 0, 12, 1},
          {"distance", "m", "from the origin, of boxes from 1 to 10 m", 0, 15, 0},
          {"motion", "", "way of a box in one step over its size", -3, 6, -1},
          {"crowd", "", "boxes more that all overlap each other", 0, 3, 0}},
         subjects,
         [context](const Subject& subject, const Point& point) { return probe(context, subject, point); }}};
}

}  // namespace kolize::cli::stability
