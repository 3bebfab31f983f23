#include "metamorphic.h"

#include "broadphase_under_test.h"

#include <random>

namespace kolize {

namespace {

class MetamorphicBroadphase : BroadphaseUnderTest {
public:
    using BroadphaseUnderTest::BroadphaseUnderTest;

    // What an incremental plugin lives on: most rows stay as they are, one or two jump, and now and then nothing moves
    // or the rows mean something else.
    void few_rows_move() const {
        std::mt19937_64 random(options_.seed);
        const auto host = make_host(1);
        const auto stage = make(*host);
        BoxScene boxes = uniform_boxes(200, options_.seed);
        std::uint64_t generation = 1;
        for (int frame = 0; frame < 60; ++frame) {
            expect_same(find(*stage, boxes, generation), boxes, "frame " + std::to_string(frame) + " of few that move");
            if (frame % 7 == 6) continue;
            if (frame % 20 == 19) {
                ++generation;
                boxes.is_static[random() % boxes.is_static.size()] ^= 1;
            }
            move_few(boxes, random);
        }
    }

    // Nothing may be shared between objects.
    void two_objects() const {
        const auto host = make_host(1);
        const auto first = make(*host), second = make(*host);
        BoxScene one = uniform_boxes(150, options_.seed), other = uniform_boxes(150, options_.seed + 1);
        for (std::uint64_t frame = 0; frame < 10; ++frame) {
            expect_same(find(*first, one, 1), one, "in the first of two objects");
            expect_same(find(*second, other, 1), other, "in the second of two objects");
            move_boxes(one, frame);
            move_boxes(other, frame + 100);
        }
    }

    // What divides space changes nothing about who meets whom.
    void references() const {
        std::mt19937_64 random(options_.seed);
        const auto host = make_host(1);
        const auto stage = make(*host);
        for (std::uint64_t generation = 1; generation <= 10; ++generation) {
            BoxScene boxes = uniform_boxes(150, generation);
            boxes.is_reference.assign(boxes.bounds.size(), 0);
            for (std::size_t row = 0; row < boxes.bounds.size(); row += 15) make_reference(boxes, row, random);
            for (int frame = 0; frame < 3; ++frame) {
                expect_right(find(*stage, boxes, generation), boxes, "with rows that are references");
                move_boxes(boxes, random());
            }
        }
    }

    void exact() const {
        if (!plugin_.descriptor->capabilities.exact) throw Inapplicable("it does not declare itself exact");
        for (const BoxSceneKind& kind : box_scene_kinds()) expect_right(kind.make(options_.seed), inexact);
        const auto host = make_host(1);
        const auto stage = make(*host);
        BoxScene boxes = uniform_boxes(200, options_.seed);
        for (std::uint64_t frame = 0; frame < 20; ++frame) {
            if (const std::string wrong = inexact(boxes, find(*stage, boxes, 1)); !wrong.empty())
                throw Violation("frame " + std::to_string(frame) + " of moving boxes: " + wrong + ": " +
                                to_code(boxes));
            move_boxes(boxes, options_.seed + frame);
        }
    }

private:
    static void move_few(BoxScene& boxes, std::mt19937_64& random) {
        const BoxScene elsewhere = uniform_boxes(boxes.bounds.size(), random());
        for (int moved = 0; moved < 2; ++moved) {
            const std::size_t row = random() % boxes.bounds.size();
            if (!boxes.is_static[row]) boxes.bounds[row] = elsewhere.bounds[row];
        }
        BoxScene slightly = boxes;
        move_boxes(slightly, random());
        for (std::size_t row = random() % 20; row < boxes.bounds.size(); row += 20)
            boxes.bounds[row] = slightly.bounds[row];
    }

    // Larger than the others, as a room is; static or not.
    static void make_reference(BoxScene& boxes, std::size_t row, std::mt19937_64& random) {
        boxes.is_reference[row] = 1;
        boxes.is_static[row] = random() % 2;
        boxes.bounds[row].max += Vec3::Constant(static_cast<double>(random() % 4));
    }
};

}  // namespace

void check_metamorphic_broadphase(const PluginLibrary& library, const LoadedPlugin& plugin,
                                  const ConformanceOptions& options, Suite& suite) {
    const MetamorphicBroadphase checks(library, plugin, options);
    suite.run("few rows move, some jump", [&] { checks.few_rows_move(); });
    suite.run("two objects at a time", [&] { checks.two_objects(); });
    suite.run("rows that are references", [&] { checks.references(); });
    suite.run("exact as declared", [&] { checks.exact(); });
}

}  // namespace kolize
