#include <kolize/observer.h>

namespace kolize {

void Observer::step_begins(std::uint64_t, const World&) {}
void Observer::step_ended(std::uint64_t, const World&) {}
void Observer::ended(const Span&) {}
void Observer::broadphase_found(const BroadphaseInput&, std::span<const Pair>) {}
void Observer::narrowphase_found(const NarrowphaseInput&, bool, const Contacts&) {}
void Observer::narrowphase_timed(const ImpactInput&, std::span<const double>) {}
void Observer::response_begins(std::size_t, const ResponseInput&, const World&) {}
void Observer::response_ended(std::size_t, const ResponseInput&, const World&) {}

}  // namespace kolize
