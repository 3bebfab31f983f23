// Scenes of impacts for the response suite.
#pragma once

#include <kolize/response.h>

#include <cstdint>
#include <string>
#include <vector>

namespace kolize {

struct ImpactScene {
    World world;
    std::vector<Contact> contacts;  // canonical order
    std::vector<std::uint8_t> hit;
};

// Random bodies, some static, some without a contact, and `count` contacts between them. Rows hold what `detail` says.
ImpactScene random_impacts(std::size_t count, Detail detail, double restitution, std::uint64_t seed);

// The same scene turned and moved as a whole.
ImpactScene moved(const ImpactScene& scene, const Quat& turn, const Vec3& shift);

// The same scene with body i as body number[i]; contacts in canonical order again, A and B swapped where they have to
// be.
ImpactScene renumbered(const ImpactScene& scene, const std::vector<std::uint32_t>& number);

// The same scene with left and right exchanged: x is -x.
ImpactScene mirrored(const ImpactScene& scene);

// All masses and moments of inertia times `by`.
ImpactScene heavier(const ImpactScene& scene, double by);

// The bodies and contacts as text that tells one case from another and can be rebuilt from.
std::string to_text(const ImpactScene& scene);

}  // namespace kolize
