// Contacts: what the narrowphase finds and the response acts on. The meaning of each column is written here and
// nowhere else.
#pragma once

#include <kolize/broadphase.h>

#include <cstdint>
#include <span>
#include <vector>

namespace kolize {

// How much the response wants to know about a pair. Each level includes the ones before it.
//   overlap   that the two bodies overlap: one row a pair; normal, arms and depth are zero
//   normal    one contact a region: point, normal, depth
//   manifold  up to four well-spread points a region, all with the region's normal
enum class Detail : std::uint32_t { overlap, normal, manifold };

KOLIZE_API const char* to_string(Detail);

// One contact point. Rows of a step stand in canonical order: by pair (a, b), then by region, then by point.
struct Contact {
    std::uint32_t a = 0;  // body ids, a < b
    std::uint32_t b = 0;
    std::uint32_t region = 0;    // numbers the contact regions of this pair from 0
    std::uint32_t rule = 0;      // set by the framework: the response rule that takes the pair
    Vec3 normal = Vec3::Zero();  // unit, world axes, from body A to body B: B has to move along it to separate
    Vec3 arm_a = Vec3::Zero();   // contact point minus the centre of mass of A, world axes, m
    Vec3 arm_b = Vec3::Zero();   // the same point minus the centre of mass of B, world axes, m
    // m, > 0 where bodies overlap. Detail `normal`: the longest chord of the region along its normal (of two convex
    // primitives: how far B has to move along it to separate). `manifold`: the chord at this point. 0 where bodies
    // touch at the time of impact. Of bodies that rest on each other see ResponseInput::settle.
    double depth = 0;
    // Written by the response: what B got here; A got the opposite.
    double impulse = 0;            // along the normal, N s, >= 0
    Vec3 friction = Vec3::Zero();  // across it, at the contact point, N s
    Vec3 couple = Vec3::Zero();    // angular impulse without a force (rolling, drilling, sticking), N m s

    Vec3 total_impulse() const { return impulse * normal + friction; }
};

// What one narrowphase call gives. Cleared, never freed, between steps.
struct Contacts {
    std::vector<Contact> rows;
    std::uint64_t triangle_tests = 0;  // triangle pairs handed to the triangle test
    std::uint64_t triangle_hits = 0;   // of them, those that intersect
    std::uint64_t failures = 0;        // pairs over which the method failed; what was answered instead, its page says

    void clear() {
        rows.clear();
        triangle_tests = triangle_hits = failures = 0;
    }
};

// A piece of the curve along which the surfaces of two bodies cross. World frame, m.
struct CrossingLine {
    Pair pair;
    std::uint32_t loop = 0;  // numbers the closed curves of this pair from 0
    Vec3 from = Vec3::Zero();
    Vec3 to = Vec3::Zero();
};

}  // namespace kolize
