// Broadphase by brute force: every box against every other, as overlap is defined. Every other broadphase is judged by
// it.
#include <kolize/plugin.h>

namespace {

class BruteForce final : public kolize::Broadphase {
public:
    void find_pairs(const kolize::BroadphaseInput& input, std::vector<kolize::Pair>& pairs) override {
        kolize::require_valid_bounds(input.bounds);
        const auto rows = static_cast<std::uint32_t>(input.bounds.size());
        for (std::uint32_t a = 0; a < rows; ++a)
            for (std::uint32_t b = a + 1; b < rows; ++b) {
                if (input.is_static[a] && input.is_static[b]) continue;
                if (input.bounds[a].overlaps(input.bounds[b])) pairs.push_back({a, b});
            }
    }
};

}  // namespace

KOLIZE_PLUGIN(BruteForce, .name = "brute_force", .summary = "every box against every other", .source = "the definition",
              .cost = "N (N - 1) / 2 box tests, no memory.",
              .accuracy = "Exact: a pair is reported if and only if its closed boxes overlap.",
              .choose = "For up to about fifty bodies, and to find out whether another broadphase is to blame.",
              .capabilities = {.exact = true})
