// Narrowphases: the triangle test against exact predicates, and pairs of boxes whose overlap is known in closed form.
#include "stability/study.h"

#include <kolize/mesh_narrowphase.h>
#include <kolize/predicates.h>

#include <algorithm>

namespace kolize::cli::stability {
namespace {

// --- Triangles -----------------------------------------------------------------------------------------------------

namespace triangles {

constexpr int rounds = 200;

enum { aspect, offset, graze, distance, size_ratio };

// A side of triangle b goes through triangle a's plane inside or outside of a's second side, as near to it as the graze
// says; or b lies in a parallel plane.
TrianglePair make(const Point& point, Dice& dice) {
    const double thin = 1 / value(point, aspect), off = value(point, offset);
    TrianglePair pair;
    pair.a[0] = {-1, -thin, 0};
    pair.a[1] = {1, -thin, 0};
    pair.a[2] = {dice.between(-1, 1), thin, 0};
    const double along = dice.between(0.2, 0.8);
    const double into = (dice.below(2) ? 0.2 : -0.2) * value(point, graze);
    const Vec3 aim = (1 - along) * pair.a[1] + along * pair.a[2] + into * (pair.a[0] - pair.a[1]);
    const double size = 1 / value(point, size_ratio);
    pair.b[0] = aim + size * dice.point(2);
    pair.b[1] = 2 * aim - pair.b[0];
    pair.b[2] = pair.b[0] + size * dice.point(2);
    for (Vec3& p : pair.b) p.z() *= off;
    if (dice.below(4) == 0) pair.b[2].z() = pair.b[1].z() = pair.b[0].z();  // parallel planes
    const Mat3 turn = dice.below(2) ? Mat3(Mat3::Identity()) : dice.rotation().toRotationMatrix();
    const Vec3 shift = value(point, distance) * dice.direction();
    for (Vec3* triangle : {pair.a, pair.b})
        for (int k = 0; k < 3; ++k) triangle[k] = turn * triangle[k] + shift;
    return pair;
}

Outcome probe(const Context& context, const Subject& subject, const Point& point) {
    const auto stage = context.plugins.make<Narrowphase>(subject.config, context.host);
    const auto& test = dynamic_cast<const TriangleNarrowphase&>(*stage);
    Dice dice(context.seed);
    std::vector<TrianglePair> pairs;
    for (int round = 0; round < rounds; ++round) pairs.push_back(make(point, dice));
    std::vector<std::uint8_t> hit(pairs.size());
    test.intersect_triangles(pairs, hit, {});
    int missed = 0, false_hits = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const bool meet = triangles_intersect(pairs[i].a, pairs[i].b);
        missed += meet && !hit[i];
        false_hits += !meet && hit[i];
    }
    if (missed + false_hits == 0) return {};
    return {missed ? Failure::missed : Failure::wrong,
            "of " + std::to_string(rounds) + " pairs " + std::to_string(missed) + " that meet are missed, " +
                std::to_string(false_hits) + " are reported that do not meet"};
}

Study study(const Context& context, const std::vector<Subject>& subjects) {
    Study study{
        "narrowphase",
        "triangles",
        "200 pairs of triangles, half of them turned, a side of one through the plane of the other, inside it or "
        "beside it: hit or not, "
        "for the corners as rounded. Oracle: exact predicates.",
        {{"aspect", "", "length of a triangle over its height", 0, 15, 0},
         {"offset", "", "height of the second triangle over the first one's plane", 0, -300, 0},
         {"graze", "", "way from a side to the point that is hit or just missed, over the other side", 0, -16, 0},
         {"distance", "m", "from the origin, of triangles of 2 m", -1, 15, -1},
         {"size_ratio", "", "one triangle over the other", 0, 15, 0}},
        {},
        [context](const Subject& subject, const Point& point) { return probe(context, subject, point); }};
    for (const Subject& subject : subjects) {
        const auto stage = context.plugins.make<Narrowphase>(subject.config, context.host);
        if (dynamic_cast<const TriangleNarrowphase*>(stage.get()))
            study.subjects.push_back(subject);
        else
            study.left_out.push_back(subject.name + ": it tests no single triangles");
    }
    return study;
}

}  // namespace triangles

// --- Boxes ---------------------------------------------------------------------------------------------------------

namespace boxes {

constexpr int rounds = 20;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

enum { depth, distance, size_ratio, aspect };
enum class Output { overlap, depth, normal };

struct Case {
    World world;
    double overlap;  // m; below 0: the gap
    Vec3 normal;
    double size;    // m, of the larger box: what roundings are measured by
    double leeway;  // m, by which the rounding of the orientation may change the overlap
};

Shape make_shape(const char* name, const Vec3& half_extents, bool as_mesh) {
    return as_mesh ? make_mesh(name, box_soup(half_extents)) : make_box(name, half_extents);
}

// The small box stands on the large one, turned about the vertical: sunk in by the depth, or as far above it.
Case make(const Point& point, bool as_mesh, Dice& dice) {
    const double ratio = value(point, size_ratio), thin = 1 / value(point, aspect);
    const Vec3 large(ratio, ratio, ratio), small(0.5, 0.5 * thin, 0.4);
    const double wanted = value(point, depth) * (dice.below(3) ? 1 : -1);
    const bool straight = dice.below(2);
    const Quat turn = straight ? Quat(Quat::Identity()) : dice.rotation();
    const Vec3 origin = value(point, distance) * dice.direction();
    const double x = 0.3 * ratio * dice.between(-1, 1), z = 0.3 * ratio * dice.between(-1, 1);
    Case made;
    made.size = 2 * ratio;
    made.world.materials.emplace_back();
    made.world.shapes = {make_shape("large", large, as_mesh), make_shape("small", small, as_mesh)};
    BodyDescription body;
    body.mass = 1;
    body.position = origin;
    body.orientation = turn;
    made.world.add(body);
    body.shape = 1;
    body.position = origin + turn * Vec3(x, large.y() + small.y() - wanted, z);
    body.orientation = turn * Quat(Eigen::AngleAxisd(dice.between(0.1, 1.4), Vec3::UnitY()));
    made.world.add(body);
    made.normal = turn * Vec3::UnitY();
    const Vec3 apart = made.world.position[1] - made.world.position[0];
    using Long = long double;
    Long along = 0;
    for (int k = 0; k < 3; ++k) along += Long(apart[k]) * Long(made.normal[k]);
    made.overlap = static_cast<double>(Long(large.y()) + Long(small.y()) - along);
    made.leeway = straight ? epsilon * made.size : 4 * epsilon * made.size;
    return made;
}

Outcome judge(const Case& made, const std::vector<Contact>& rows, Output output) {
    const bool decided = std::abs(made.overlap) > made.leeway;
    if (output == Output::overlap) {
        if (decided && rows.empty() == (made.overlap > 0))
            return made.overlap > 0
                       ? Outcome{Failure::missed, "boxes that overlap by " + number(made.overlap) + " m are not found"}
                       : Outcome{Failure::wrong, "boxes " + number(-made.overlap) + " m apart are found to overlap"};
        return {};
    }
    if (made.overlap <= made.leeway || rows.empty()) return {};  // another output's matter
    double deepest = 0, tilt = 0;
    for (const Contact& c : rows) {
        if (!c.normal.allFinite() || !std::isfinite(c.depth)) return {Failure::not_finite, "a contact is not finite"};
        deepest = std::max(deepest, c.depth);
        tilt = std::max(tilt, std::atan2(c.normal.cross(made.normal).norm(), c.normal.dot(made.normal)));
    }
    const double error = std::abs(deepest - made.overlap);
    if (output == Output::depth && !(error <= 64 * epsilon * made.size))
        return {Failure::inaccurate,
                "the depth of an overlap of " + number(made.overlap) + " m is off by " + number(error) + " m"};
    if (output == Output::normal && !(tilt <= 1e-6))
        return {tilt > 0.1 ? Failure::wrong : Failure::inaccurate, "the normal is off by " + number(tilt) + " rad"};
    return {};
}

Outcome probe(const Context& context, const Subject& subject, const Point& point, Output output) {
    const bool meshes = subject.plugin->descriptor->capabilities.shape_kinds & bit(ShapeKind::mesh);
    Dice dice(context.seed);
    for (int round = 0; round < rounds; ++round) {
        const Case made = make(point, meshes, dice);
        const auto stage = context.plugins.make<Narrowphase>(subject.config, context.host);
        stage->prepare(made.world);
        const Pair pair{0, 1};
        const Detail detail = output == Output::overlap ? Detail::overlap : Detail::normal;
        Contacts contacts;
        stage->find_contacts({made.world, {&pair, 1}, {&detail, 1}}, contacts);
        if (const Outcome outcome = judge(made, contacts.rows, output); !outcome.holds()) return outcome;
    }
    return {};
}

Study study(const Context& context, const std::vector<Subject>& subjects, Output output) {
    const char* const names[] = {"overlap", "depth", "normal"};
    const char* const questions[] = {
        "overlapping or not, where the rounding of the orientation does not leave that open",
        "the depth, to 64 roundings of the larger box's side", "the normal, to a millionth of a radian"};
    const auto index = static_cast<std::size_t>(output);
    Study study{
        "narrowphase",
        names[index],
        std::string("20 pairs of boxes, as meshes where the plugin takes meshes, one on top of the other, half of the "
                    "pairs turned: ") +
            questions[index] + ". Oracle: closed form, of the poses as rounded.",
        {{"depth", "m", "overlap or gap of a box of 1 m", -1, -15, -1},
         {"distance", "m", "from the origin, of boxes of 1 m", 0, 15, 0},
         {"size_ratio", "", "one box over the other", 0, 12, 0},
         {"aspect", "", "length of the thin box over its height", 0, 15, 0}},
        {},
        [context, output](const Subject& subject, const Point& point) {
            return probe(context, subject, point, output);
        }};
    for (const Subject& subject : subjects) {
        const Capabilities& can = subject.plugin->descriptor->capabilities;
        if (can.bounding_spheres)
            study.left_out.push_back(subject.name + ": it answers for bounding volumes, not for the bodies");
        else if (!(can.shape_kinds & bit(ShapeKind::box)))
            study.left_out.push_back(subject.name + ": it takes no boxes");
        else if (output != Output::overlap && can.gives == Detail::overlap)
            study.left_out.push_back(subject.name + ": it gives no more than that bodies overlap");
        else
            study.subjects.push_back(subject);
    }
    return study;
}

}  // namespace boxes

}  // namespace

std::vector<Study> narrowphase_studies(const Context& context, const std::vector<Subject>& subjects) {
    return {triangles::study(context, subjects), boxes::study(context, subjects, boxes::Output::overlap),
            boxes::study(context, subjects, boxes::Output::depth),
            boxes::study(context, subjects, boxes::Output::normal)};
}

}  // namespace kolize::cli::stability
