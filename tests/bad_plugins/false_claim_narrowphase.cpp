// A narrowphase whose descriptor claims what it does not keep; CLAIM says what.
#include <kolize/mesh_narrowphase.h>
#include <kolize/plugin.h>
#include <kolize/predicates.h>

namespace {

using namespace kolize;

enum class Claim { exact, any_size, crossings, time_of_impact, gives, no_allocations, no_memory };
constexpr Claim claim = Claim::CLAIM;

// Exact, but for triangles that only touch (`exact`), or that are small (`any_size`).
class Triangles final : public TriangleNarrowphase {
public:
    static void parameters(Parameters<Triangles>& p) { mesh_parameters<Triangles>(p); }

    void intersect_triangles(std::span<const TrianglePair> pairs, std::span<std::uint8_t> hit,
                             std::span<TriangleSegment> segments) const override {
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            hit[i] = triangles_intersect(pairs[i].a, pairs[i].b) && !overlooks(pairs[i]);
            if (!hit[i] || segments.empty()) continue;
            const CommonSegment common = common_segment(pairs[i].a, pairs[i].b);
            segments[i] = {common.begin, common.end};
        }
    }

private:
    static bool overlooks(const TrianglePair& pair) {
        if (claim == Claim::any_size) return (pair.a[1] - pair.a[0]).norm() < 1e-3;
        const CommonSegment common = common_segment(pair.a, pair.b);
        return common.begin == common.end;
    }
};

// Finds that every pair overlaps.
class Everything final : public Narrowphase {
public:
    Detail gives() const override { return Detail::manifold; }
    void prepare(const World&) override {}

    void find_contacts(const NarrowphaseInput& input, Contacts& contacts) override {
        for (const Pair pair : input.pairs) {
            contacts.rows.push_back({.a = pair.a, .b = pair.b, .depth = claim == Claim::no_memory ? calls_ : 0});
            if (claim == Claim::no_allocations) wasted_ = std::make_unique<int>(1);
        }
        ++calls_;
    }

private:
    double calls_ = 0;
    std::unique_ptr<int> wasted_;
};

using Liar = std::conditional_t<claim == Claim::exact || claim == Claim::any_size, Triangles, Everything>;

}  // namespace

KOLIZE_PLUGIN(Liar, .name = CLAIM_NAME, .summary = "claims what it does not keep", .source = "none",
              .capabilities = {.gives = claim == Claim::gives ? Detail::normal : Detail::manifold,
                               .time_of_impact = claim == Claim::time_of_impact,
                               .exact = claim == Claim::exact,
                               .crossings = claim == Claim::crossings})
