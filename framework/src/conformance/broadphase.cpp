#include "broadphase_under_test.h"
#include "metamorphic.h"

#include <algorithm>
#include <numeric>
#include <random>

namespace kolize {

namespace {

// The plugin under test; the checks are its member functions.
class BroadphaseChecks : BroadphaseUnderTest {
public:
    using BroadphaseUnderTest::BroadphaseUnderTest;

    void scene(const BoxSceneKind& kind) const {
        for (std::uint64_t seed = options_.seed; seed < options_.seed + 3; ++seed) expect_right(kind.make(seed));
    }

    void small_counts() const {
        for (std::size_t count = 0; count <= 3; ++count)
            for (std::uint64_t seed = options_.seed; seed < options_.seed + 10; ++seed)
                expect_right(uniform_boxes(count, seed));
    }

    void permuted_rows() const {
        std::mt19937_64 random(options_.seed);
        const BoxScene boxes = uniform_boxes(200, options_.seed);
        std::vector<std::uint32_t> order(boxes.bounds.size());
        std::iota(order.begin(), order.end(), 0u);
        for (int round = 0; round < 4; ++round) {
            std::shuffle(order.begin(), order.end(), random);
            expect_right(permute(boxes, order));
        }
    }

    // Scaling by a power of two and turning by a right angle change no comparison.
    void moved_whole() const {
        BoxScene boxes = uniform_boxes(200, options_.seed);
        for (const double scale : {0x1p-30, 0x1p60}) {
            for (Aabb& box : boxes.bounds) {
                box = {scale * box.min, scale * box.max};
                box = {{-box.max.y(), box.min.x(), box.min.z()}, {-box.min.y(), box.max.x(), box.max.z()}};
            }
            expect_right(boxes);
        }
    }

    // One object over many frames gives what a new object gives for each.
    void motion() const {
        const auto host = make_host(1);
        const auto stage = make(*host);
        BoxScene boxes = uniform_boxes(200, options_.seed);
        for (std::size_t row = 0; row < boxes.is_static.size(); row += 3) boxes.is_static[row] = 1;
        for (std::uint64_t frame = 0; frame < 40; ++frame) {
            expect_same(find(*stage, boxes, 1), boxes, "frame " + std::to_string(frame) + " of moving boxes");
            move_boxes(boxes, options_.seed + frame);
        }
    }

    void changed_generation() const {
        std::mt19937_64 random(options_.seed);
        const auto host = make_host(1);
        const auto stage = make(*host);
        for (std::uint64_t generation = 1; generation <= 40; ++generation) {
            BoxScene boxes = uniform_boxes(random() % 100, generation);
            for (std::uint8_t& flag : boxes.is_static) flag = random() % 2;
            for (int frame = 0; frame < 3; ++frame) {
                expect_same(find(*stage, boxes, generation), boxes, "generation " + std::to_string(generation));
                move_boxes(boxes, random());
            }
        }
    }

    void threads() const {
        const BoxScene boxes = uniform_boxes(2000, options_.seed);
        for (const int threads : {1, 2, 8}) {
            const auto host = make_host(threads);
            const auto stage = make(*host);
            for (int repeat = 0; repeat < 3; ++repeat)
                expect_same(find(*stage, boxes, 1), boxes, std::to_string(threads) + " threads");
        }
    }

    // The ends of every parameter's range, and each of its choices.
    void parameters() const {
        BoxScene boxes = uniform_boxes(150, options_.seed);
        boxes.bounds[3] = {Vec3::Constant(-50), Vec3::Constant(50)};
        for (const Parameter& parameter : plugin_.parameters.items)
            for (const Value& value : values_to_try(parameter)) {
                const auto host = make_host(1);
                const auto stage = make(*host, {{parameter.name, {value, {}}}});
                expect_right(find(*stage, boxes, 1), boxes, parameter.name + " = " + to_string(value));
            }
    }

    void refuses_non_finite() const {
        for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity})
            for (int axis = 0; axis < 3; ++axis) {
                expect_refused([&](Aabb& box) { box.min[axis] = bad; });
                expect_refused([&](Aabb& box) { box.max[axis] = bad; });
            }
    }

    void refuses_inverted() const {
        for (int axis = 0; axis < 3; ++axis)
            expect_refused([&](Aabb& box) { std::swap(box.min[axis], box.max[axis]); });
    }

    void warm_calls_allocate_nothing() const {
        if (plugin_.descriptor->capabilities.allocates) throw Inapplicable("it declares that its calls allocate");
        if (!options_.allocations) throw Inapplicable("this program does not count allocations");
        const auto host = make_host(1);
        const auto stage = make(*host);
        BoxScene boxes = uniform_boxes(1000, options_.seed);
        std::vector<Pair> pairs;
        pairs.reserve(100 * boxes.bounds.size());
        std::size_t count = 0;
        for (std::uint64_t call = 0; call < 20; ++call) {
            pairs.clear();
            const std::size_t before = options_.allocations();
            stage->find_pairs({boxes.bounds, boxes.is_static, 1}, pairs);
            if (call >= 3) count += options_.allocations() - before;
            move_boxes(boxes, call);
        }
        if (count > 0) throw Violation(std::to_string(count) + " allocations in 17 warm calls on 1000 moving boxes");
    }

    // What is declared, and nothing else; the same again; and the search in between is not disturbed.
    void outlines() const {
        const char* const what = plugin_.descriptor->capabilities.outline;
        const auto host = make_host(1);
        const auto stage = make(*host);
        const BoxScene boxes = uniform_boxes(150, options_.seed);
        const Outline first = outline_of(*stage, boxes);
        if (!what && !(first.boxes.empty() && first.balls.empty()))
            throw Violation("it gives an outline, and its capabilities name none");
        if (what) expect_outline(what, boxes, first);
        expect_same(find(*stage, boxes, 1), boxes, "after an outline");
        const Outline again = outline_of(*stage, boxes);
        if (again.boxes.size() != first.boxes.size() || again.balls.size() != first.balls.size())
            throw Violation("the same boxes have another outline the second time");
    }

private:
    static Outline outline_of(Broadphase& stage, const BoxScene& scene) {
        Outline outline;
        stage.outline({scene.bounds, scene.is_static, 1}, outline);
        return outline;
    }

    // Cells and spheres hold every box's lowest corner; planes are flat.
    static void expect_outline(const std::string& what, const BoxScene& scene, const Outline& outline) {
        if (outline.boxes.empty() && outline.balls.empty()) throw Violation("the outline of 150 boxes is empty");
        for (const Outline::Box& piece : outline.boxes) {
            const Vec3 size = piece.box.max - piece.box.min;
            if (!piece.box.finite() || !(size.array() >= 0).all())
                throw Violation("a box of the outline is not finite or inverted");
            if (what == "planes" && size.minCoeff() != 0) throw Violation("a plane of the outline is not flat");
        }
        for (const Outline::Ball& ball : outline.balls)
            if (!ball.center.allFinite() || !(ball.radius >= 0 && ball.radius < infinity))
                throw Violation("a ball of the outline is not finite");
        if (what != "planes") expect_covered(scene, outline);
    }

    static void expect_covered(const BoxScene& scene, const Outline& outline) {
        const Vec3 rounding = Vec3::Constant(1e-9);  // m; the boxes are about 1 m large
        for (std::size_t row = 0; row < scene.bounds.size(); ++row) {
            const Vec3& corner = scene.bounds[row].min;
            const bool in_box = std::any_of(outline.boxes.begin(), outline.boxes.end(), [&](const Outline::Box& piece) {
                return piece.box.overlaps({corner - rounding, corner + rounding});
            });
            const bool in_ball = std::any_of(
                outline.balls.begin(), outline.balls.end(),
                [&](const Outline::Ball& ball) { return (corner - ball.center).norm() <= ball.radius + rounding.x(); });
            if (!in_box && !in_ball) throw Violation("no part of the outline holds row " + std::to_string(row));
        }
    }

    template <class Spoil>
    void expect_refused(Spoil&& spoil) const {
        constexpr std::size_t bad_row = 17;
        const auto host = make_host(1);
        const auto stage = make(*host);
        const BoxScene good = uniform_boxes(30, options_.seed);
        BoxScene bad = good;
        spoil(bad.bounds[bad_row]);
        try {
            find(*stage, bad, 1);
        } catch (const std::invalid_argument& e) {
            if (std::string(e.what()).find(std::to_string(bad_row)) == std::string::npos)
                throw Violation("the message does not name row 17: " + std::string(e.what()));
            return expect_same(find(*stage, good, 2), good, "after a refused call");
        }
        throw Violation("no std::invalid_argument for row 17: " + to_code(bad));
    }
};

}  // namespace

std::vector<Check> check_broadphase(const PluginLibrary& library, const LoadedPlugin& plugin,
                                    const ConformanceOptions& options) {
    const BroadphaseChecks checks(library, plugin, options);
    Suite suite;
    for (const BoxSceneKind& kind : box_scene_kinds()) suite.run(kind.name, [&] { checks.scene(kind); });
    suite.run("none, one, two, three boxes", [&] { checks.small_counts(); });
    suite.run("permuted rows", [&] { checks.permuted_rows(); });
    suite.run("the whole scaled and turned", [&] { checks.moved_whole(); });
    suite.run("moving boxes, rows kept", [&] { checks.motion(); });
    suite.run("rows added and removed", [&] { checks.changed_generation(); });
    suite.run("1, 2 and 8 threads", [&] { checks.threads(); });
    suite.run("ends of all parameter ranges", [&] { checks.parameters(); });
    suite.run("outline", [&] { checks.outlines(); });
    suite.run("refuses non-finite boxes", [&] { checks.refuses_non_finite(); });
    suite.run("refuses inverted boxes", [&] { checks.refuses_inverted(); });
    suite.run("warm calls allocate nothing", [&] { checks.warm_calls_allocate_nothing(); });
    check_metamorphic_broadphase(library, plugin, options, suite);
    return suite.take();
}

}  // namespace kolize
