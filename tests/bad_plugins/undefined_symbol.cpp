// Needs a function that no library has, as a plugin that was linked against another release would.
#include "fixture.h"

extern "C" void kolize_function_of_another_release();

namespace {

class Needy final : public kolize::Broadphase {
public:
    void find_pairs(const kolize::BroadphaseInput&, std::vector<kolize::Pair>&) override {
        kolize_function_of_another_release();
    }
};

}  // namespace

KOLIZE_PLUGIN(Needy, .name = "needy", .summary = "cannot be linked", .source = "none")
