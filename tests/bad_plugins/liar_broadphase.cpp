// Loads, and then reports a pair whose second row does not exist.
#include "fixture.h"

namespace {

class Liar final : public kolize::Broadphase {
public:
    void find_pairs(const kolize::BroadphaseInput& input, std::vector<kolize::Pair>& pairs) override {
        pairs.push_back({0, static_cast<std::uint32_t>(input.bounds.size())});
    }
};

}  // namespace

KOLIZE_PLUGIN(Liar, .name = "liar", .summary = "a pair out of range", .source = "none")
