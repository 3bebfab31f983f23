// What is put into a running simulation from outside, between two steps: by a player, a viewer or a recording.
#pragma once

#include <kolize/scene.h>

#include <variant>

namespace kolize {

// Takes the place of gravity, wind and drag.
struct ForcesInput {
    Forces forces;
};

// Takes the place of the constant force and torque of a dynamic body.
struct LoadInput {
    std::uint32_t body = 0;
    Vec3 force = Vec3::Zero();   // at the centre of mass, world axes, N
    Vec3 torque = Vec3::Zero();  // world axes, N m
};

// A dynamic body stands and moves like this from now on, and takes part again if it had been removed.
struct PlaceInput {
    std::uint32_t body = 0;
    BodyState state;
};

// A dynamic body takes part in nothing any more.
struct RemoveInput {
    std::uint32_t body = 0;
};

// Other stages go on with the same bodies. Drifts, counts and times are measured anew from here on.
struct PipelineInput {
    PipelineConfig pipeline;
};

using Input = std::variant<ForcesInput, LoadInput, PlaceInput, RemoveInput, PipelineInput>;

}  // namespace kolize
