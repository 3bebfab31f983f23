#include "metamorphic.h"

#include "narrowphase_under_test.h"
#include "remade_solids.h"
#include "mesh_contacts.h"
#include "triangle_families.h"

#include <kolize/mesh_narrowphase.h>
#include <kolize/predicates.h>

#include <algorithm>
#include <cstdio>

namespace kolize {

namespace {

constexpr int rounds = 60;  // of random worlds, for each check

double distance_to_surface(const World& world, std::uint32_t body, const Vec3& point) {
    const Mesh& mesh = *world.shape_of(body).mesh;
    const Vec3 p = world.orientation[body].conjugate() * (point - world.position[body]);
    double distance = infinity;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        distance = std::min(distance, nearest_on_triangle(mesh, t, p).distance);
    return distance;
}

std::string to_text(const TrianglePair& pair) {
    std::string text;
    for (const auto* corners : {&pair.a, &pair.b})
        for (const Vec3& p : *corners) {
            char corner[120];
            std::snprintf(corner, sizeof corner, "{%a, %a, %a} ", p.x(), p.y(), p.z());
            text += corner;
        }
    return text;
}

class MetamorphicNarrowphase : NarrowphaseUnderTest {
public:
    using NarrowphaseUnderTest::NarrowphaseUnderTest;

    void scaled_by_powers_of_two() const {
        for (const double by : {0x1p-20, 0x1p20})
            for_each_world(
                [&](const World& world) {
                    auto there = find_pair(scaled(world, by), most_detail()).rows;
                    for (Contact& c : there) {
                        c.arm_a /= by;
                        c.arm_b /= by;
                        c.depth /= by;
                    }
                    expect_alike(world, there, "when all lengths are multiplied by a power of two");
                },
                rounds);
    }

    void mirrored_solids() const {
        const Vec3 mirror(-1, 1, 1);
        for_each_world(
            [&](const World& world) {
                auto there = find_pair(mirrored(world), most_detail()).rows;
                for (Contact& c : there) {
                    c.normal = mirror.cwiseProduct(c.normal);
                    c.arm_a = mirror.cwiseProduct(c.arm_a);
                    c.arm_b = mirror.cwiseProduct(c.arm_b);
                }
                expect_alike(world, there, "in a mirror");
            },
            rounds);
    }

    void meshes_renumbered() const {
        require_meshes();
        std::mt19937_64 random(options_.seed + 2);
        for_each_world(
            [&](const World& world) {
                const World other = renumbered_meshes(world, random);
                expect_alike(world, seen_from(world, other, find_pair(other, most_detail()).rows),
                             "when vertices and triangles are numbered otherwise");
            },
            rounds);
    }

    // Depths are passed over: the longest chord that is found hangs on where corners are. And where a half-space is
    // met, regions are made of the corners below it.
    void meshes_subdivided() const {
        require_meshes();
        for_each_world(
            [&](const World& world) {
                const bool half_space = is_half_space(world, 0) || is_half_space(world, 1);
                const Detail detail = half_space ? Detail::overlap : most_detail();
                const World fine = subdivided_meshes(world);
                expect_alike(world, without_depths(find_pair(world, detail).rows),
                             without_depths(seen_from(world, fine, find_pair(fine, detail).rows)),
                             "when every triangle is made of four");
            },
            rounds);
    }

    // What was asked before, and where bodies stood then, leaves no trace.
    void earlier_calls() const {
        const World world = crowd();
        World later = world;
        for (Vec3& p : later.position) p = Vec3(p.y(), -p.x(), p.z());
        const std::vector<Pair> pairs = all_pairs(world);
        const auto host = make_host(1);
        const auto stage = make(*host, world);
        const Contacts once = find(*stage, world, pairs, gives());
        find(*stage, later, pairs, Detail::overlap);
        find(*stage, world, {pairs.front()}, gives());
        if (!same_bits(once.rows, find(*stage, world, pairs, gives()).rows))
            throw Violation("the same pairs have other contacts after calls about others");
    }

    void gives_what_it_declares() const {
        const World world = crowd();
        for_each_setting(world, [&](const std::string& what, Narrowphase& stage) {
            if (stage.gives() > capabilities().gives)
                throw Violation(what + ": it gives " + to_string(stage.gives()) + ", and declares " +
                                to_string(capabilities().gives));
        });
    }

    // Either it refuses, in a sentence, or what it gives is finite. Few pairs: most iterations without a tolerance take
    // their time.
    void parameters() const {
        const World world = crowd();
        std::vector<Pair> pairs;
        for (std::uint32_t body = 0; body + 1 < world.size(); body += 2) pairs.push_back({body, body + 1});
        for_each_setting(world, [&](const std::string& what, Narrowphase& stage) {
            for (const Contact& c : find(stage, world, pairs, stage.gives()).rows)
                if (!c.normal.allFinite() || !c.arm_a.allFinite() || !c.arm_b.allFinite() || !(c.depth >= 0))
                    throw Violation(what + ": a contact is not finite");
        });
    }

    // Where surfaces cross is on both of them; and where they are apart is nothing.
    void crossings() const {
        if (!capabilities().crossings) throw Inapplicable("it declares that it finds no crossings");
        require_meshes();
        std::mt19937_64 random(options_.seed);
        int found = 0;
        for (int round = 0; round < 40; ++round) {
            const World world = random_two_solids(random, bit(ShapeKind::mesh));
            const Overlap expected = reference_overlap(world);
            if (expected == Overlap::too_close_to_tell) continue;
            const std::vector<CrossingLine> lines = crossings_of(world);
            if (lines.empty() != (expected == Overlap::apart))
                violate(
                    lines.empty() ? "surfaces cross, and it finds no line" : "it finds a line where nothing crosses",
                    world);
            for (const CrossingLine& line : lines)
                if (!on_both_surfaces(world, line.from) || !on_both_surfaces(world, line.to))
                    violate("a crossing line ends away from the surfaces", world);
            found += !lines.empty();
        }
        if (found < 3) throw Violation("the suite's own input does not cover crossing meshes");
    }

    void exact() const {
        if (!capabilities().exact) throw Inapplicable("it does not declare itself exact");
        const auto host = make_host(1);
        const auto stage = library_.make<Narrowphase>(default_config(plugin_), *host);
        const auto* const meshes = dynamic_cast<const MeshNarrowphase*>(stage.get());
        if (!meshes) throw Inapplicable("it does not hand out which triangles it finds");
        for (const TriangleFamily& family : triangle_families()) {
            const std::vector<TrianglePair> pairs = triangle_pairs(family, 30, options_.seed);
            if (const auto* const test = dynamic_cast<const TriangleNarrowphase*>(meshes))
                expect_exact_test(*test, pairs, family.name);
            expect_exact_meshes(*stage, *meshes, pairs, family.name);
        }
    }

private:
    // The defaults, and each parameter at its ends and choices, the others at their defaults, as far as it takes them.
    template <class CheckStage>
    void for_each_setting(const World& world, CheckStage&& check) const {
        const auto host = make_host(1);
        check("the defaults", *make(*host, world));
        for (const Parameter& parameter : plugin_.parameters.items)
            for (const Value& value : values_to_try(parameter)) {
                StagePtr<Narrowphase> stage(nullptr, [](Stage*) {});
                try {
                    stage = make(*host, world, {{parameter.name, {value, {}}}});
                } catch (const Error&) {
                    continue;
                }
                check(parameter.name + " = " + to_string(value), *stage);
            }
    }

    // Which points of a region are taken may hang on the last digit.
    Detail most_detail() const { return std::min(gives(), Detail::normal); }

    void require_meshes() const {
        if (!(capabilities().shape_kinds & bit(ShapeKind::mesh))) throw Inapplicable("it takes no meshes");
    }

    static bool is_half_space(const World& world, std::uint32_t body) {
        return world.shape_of(body).kind == ShapeKind::half_space;
    }

    static std::vector<Contact> without_depths(std::vector<Contact> rows) {
        for (Contact& c : rows) c.depth = 0;
        return rows;
    }

    // Arms are compared in space: the centre of mass of a solid made anew may differ in the last digits.
    static std::vector<Contact> seen_from(const World& world, const World& other, std::vector<Contact> rows) {
        for (Contact& c : rows) {
            if (c.normal.isZero(0)) continue;  // no more than the overlap was asked for
            c.arm_a += other.position[0] - world.position[0];
            c.arm_b += other.position[1] - world.position[1];
        }
        return rows;
    }

    void expect_alike(const World& world, const std::vector<Contact>& here, const std::vector<Contact>& there,
                      const std::string& when) const {
        if (reference_overlap(world) == Overlap::too_close_to_tell && !capabilities().exact) return;
        if (!same_geometry(here, there, tolerance)) violate("other contacts " + when, world);
    }
    void expect_alike(const World& world, const std::vector<Contact>& there, const std::string& when) const {
        expect_alike(world, find_pair(world, most_detail()).rows, there, when);
    }

    std::vector<CrossingLine> crossings_of(const World& world) const {
        const auto host = make_host(1);
        const Pair pair{0, 1};
        const Detail detail = Detail::normal;
        std::vector<CrossingLine> lines;
        make(*host, world)->find_crossings({world, {&pair, 1}, {&detail, 1}}, lines);
        return lines;
    }

    static bool on_both_surfaces(const World& world, const Vec3& point) {
        return distance_to_surface(world, 0, point) < 1e-6 && distance_to_surface(world, 1, point) < 1e-6;
    }

    static void expect_exact_test(const TriangleNarrowphase& test, const std::vector<TrianglePair>& pairs,
                                  const std::string& family) {
        std::vector<std::uint8_t> hit(pairs.size());
        test.intersect_triangles(pairs, hit, {});
        for (std::size_t i = 0; i < pairs.size(); ++i)
            if (const bool meet = triangles_intersect(pairs[i].a, pairs[i].b); meet != bool(hit[i]))
                throw Violation(std::string("it declares itself exact, and two triangles (") + family + ") " +
                                (meet ? "meet" : "are apart") +
                                " that it takes for the opposite: " + to_text(pairs[i]));
    }

    // The first triangles of all pairs as one surface, the second ones as another, in one frame.
    static void expect_exact_meshes(Narrowphase& stage, const MeshNarrowphase& meshes,
                                    const std::vector<TrianglePair>& pairs, const std::string& family) {
        World world;
        world.shapes = {surface(pairs, &TrianglePair::a), surface(pairs, &TrianglePair::b)};
        stage.prepare(world);
        TriangleHits hits;
        meshes.intersect_meshes({*world.shapes[0].mesh, *world.shapes[1].mesh, {Mat3::Identity(), Vec3::Zero()}, 0, 1},
                                hits);
        std::vector<std::uint8_t> found(pairs.size() * pairs.size(), 0);
        for (const TriangleHit& hit : hits.hits) found.at(hit.a * pairs.size() + hit.b) = 1;
        for (std::size_t i = 0; i < pairs.size(); ++i)
            for (std::size_t j = 0; j < pairs.size(); ++j)
                if (triangles_intersect(pairs[i].a, pairs[j].b) != bool(found[i * pairs.size() + j]))
                    throw Violation("it declares itself exact, and of two surfaces (" + family +
                                    ") it does not find just the triangles that meet");
    }

    static Shape surface(const std::vector<TrianglePair>& pairs, Vec3 (TrianglePair::*corners)[3]) {
        TriangleSoup soup;
        for (const TrianglePair& pair : pairs) {
            const auto first = static_cast<std::uint32_t>(soup.vertices.size());
            soup.vertices.insert(soup.vertices.end(), std::begin(pair.*corners), std::end(pair.*corners));
            soup.triangles.push_back({first, first + 1, first + 2});
        }
        Shape shape = make_surface("triangles", soup);
        shape.mesh = build_mesh(soup);  // where they are, not about their middle
        shape.bounds = shape.mesh->bounds;
        shape.radius = shape.mesh->radius;
        return shape;
    }
};

}  // namespace

void check_metamorphic_narrowphase(const PluginLibrary& library, const LoadedPlugin& plugin,
                                   const ConformanceOptions& options, Suite& suite) {
    const MetamorphicNarrowphase checks(library, plugin, options);
    suite.run("the whole scaled by powers of two", [&] { checks.scaled_by_powers_of_two(); });
    suite.run("the whole in a mirror", [&] { checks.mirrored_solids(); });
    suite.run("vertices and triangles renumbered", [&] { checks.meshes_renumbered(); });
    suite.run("triangles subdivided", [&] { checks.meshes_subdivided(); });
    suite.run("earlier calls leave no trace", [&] { checks.earlier_calls(); });
    suite.run("ends of all parameter ranges", [&] { checks.parameters(); });
    suite.run("gives no more than it declares", [&] { checks.gives_what_it_declares(); });
    suite.run("crossings as declared", [&] { checks.crossings(); });
    suite.run("exact as declared", [&] { checks.exact(); });
}

}  // namespace kolize
