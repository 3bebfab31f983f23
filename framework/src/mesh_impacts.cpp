// The part of MeshNarrowphase that serves stepping `continuous`.
#include <kolize/mesh_narrowphase.h>

#include "sweep/workspace.h"

#include <algorithm>

namespace kolize {

namespace {

constexpr std::size_t min_grain = 4;  // pairs; less is not worth a task

// B is the half-space if there is one.
bool must_swap(const World& world, const Pair& pair) { return world.shape_of(pair.a).kind == ShapeKind::half_space; }

// The bodies as they stand, whatever the time.
class Standstill final : public Flow {
public:
    explicit Standstill(const World& world) : world_(world) {}
    BodyState at(std::uint32_t body, double) const override {
        return {world_.position[body], world_.orientation[body], Vec3::Zero(), Vec3::Zero()};
    }
    MotionBound bound(std::uint32_t) const override { return {}; }

private:
    const World& world_;
};

}  // namespace

void MeshNarrowphase::find_impacts(const ImpactInput& input, std::span<double> times) {
    const std::size_t count = input.pairs.size();
    const std::size_t grain = std::max(min_grain, (count + sweeps_.size() - 1) / sweeps_.size());
    host().parallel_for(count, grain, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Pair& pair = input.pairs[i];
            const bool swap = must_swap(input.world, pair);
            const MovingPair moving(input.world, input.flow, swap ? pair.b : pair.a, swap ? pair.a : pair.b);
            times[i] = find_impact(moving, input.from, input.until, sweeps_[chunk]->scratch);
        }
    });
}

void MeshNarrowphase::find_touching(const NarrowphaseInput& input, Contacts& contacts) {
    const Standstill still(input.world);
    SweepWorkspace& sweep = *sweeps_.front();
    for (std::size_t i = 0; i < input.pairs.size(); ++i) {
        const Pair& pair = input.pairs[i];
        const bool swap = must_swap(input.world, pair);
        const std::uint32_t first = swap ? pair.b : pair.a, second = swap ? pair.a : pair.b;
        const MovingPair moving(input.world, still, first, second);
        sweep.points.clear();
        find_touching_points(moving, moving.at(0), input.reach, sweep.scratch, sweep.points);
        const Mat3 to_world = input.world.orientation[first].toRotationMatrix();
        const Vec3 offset = input.world.position[second] - input.world.position[first];
        Contact contact;
        contact.a = pair.a;
        contact.b = pair.b;
        for (const TouchingPoint& touching : sweep.points) {
            if (input.detail[i] != Detail::overlap) {
                const Vec3 arm = to_world * touching.point, normal = to_world * touching.normal;
                contact.normal = swap ? Vec3(-normal) : normal;
                contact.arm_a = swap ? Vec3(arm - offset) : arm;
                contact.arm_b = swap ? arm : Vec3(arm - offset);
                contact.depth = touching.gap > 0 ? -touching.gap : 0;
            }
            contacts.rows.push_back(contact);
            ++contact.region;
            if (input.detail[i] == Detail::overlap) break;
        }
    }
}

}  // namespace kolize
