// Response: from contacts to changed velocities, removed bodies and events.
#pragma once

#include <kolize/contact.h>
#include <kolize/world.h>

namespace kolize {

enum class EventKind : std::uint32_t { explosion, removal };

struct Event {
    EventKind kind = EventKind::explosion;
    std::uint32_t body = 0;
    Vec3 position = Vec3::Zero();  // world frame, m
};

struct ResponseInput {
    std::span<Contact> contacts;  // those that the rule takes, in canonical order; see Contact for what is written
    std::span<const std::uint8_t> hit;  // per contact: bit 0 set if body A fits the rule's `when`, bit 1 for body B
    double dt = 0;                      // s
    // s. Above 0 the bodies rest on each other for so long. Nothing bounces then, whatever the restitution, and `depth`
    // is how far a contact has to part in that time, or, below 0, how far it may close.
    double settle = 0;

    // The approach that a contact may keep, m/s; below 0: the speed at which it has to part.
    double allowed_approach(const Contact& c) const { return settle > 0 ? -c.depth / settle : 0; }
};

struct ResponseOutput {
    std::vector<Event>& events;  // append; the framework removes the body of a removal event after the stage
    double dissipated_J = 0;     // add the kinetic energy that restitution < 1 takes away, so that drift is error only
    std::uint64_t unresolved = 0;  // add the contacts still approaching when an iteration limit was reached
};

// Contract (held by the conformance suite for every plugin):
// - writes velocities and angular velocities of the dynamic bodies in its contacts, events and impulses; if it `moves`,
//   their positions and orientations too, to part what overlaps; if it `sleeps`, their World::asleep; nothing else;
// - sees all contacts of its rule in a step at once, and depends on their order only through the canonical one;
// - reports every impulse it gives, so that momentum exchanged with static bodies can be accounted for;
// - finite input gives finite output; warm calls allocate nothing.
class KOLIZE_API Response : public Stage {
public:
    static constexpr StageKind kind = StageKind::response;

    virtual void respond(const ResponseInput& input, World& world, ResponseOutput& output) = 0;

    // What it remembers from one step to the next, as words: save() appends, restore() takes them back in another
    // object with the same parameters, which then goes on to the same bits. restore() with no words forgets.
    // Throws std::invalid_argument for words that save() cannot have given.
    virtual void save(std::vector<std::uint64_t>& words) const;
    virtual void restore(std::span<const std::uint64_t> words);
};

}  // namespace kolize
