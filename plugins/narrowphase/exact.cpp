// Triangle-triangle test that decides as real arithmetic on the corners would: the judge of all others.
//
// Signs of orientation determinants decide, with the triangles' planes first, as in guigue_devillers; triangles in one
// plane or without area are tested side against side. Each sign comes from floating point where its error bound leaves
// no doubt, and from exact arithmetic (expansions, then whole numbers) where it does: see kolize/predicates.h.
#include <kolize/mesh_narrowphase.h>
#include <kolize/plugin.h>
#include <kolize/predicates.h>

namespace {

using namespace kolize;

class Exact final : public TriangleNarrowphase {
public:
    static void parameters(Parameters<Exact>& p) { mesh_parameters<Exact>(p); }

private:
    void intersect_triangles(std::span<const TrianglePair> pairs, std::span<std::uint8_t> hit,
                             std::span<TriangleSegment> segments) const override {
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            hit[i] = triangles_intersect(pairs[i].a, pairs[i].b);
            if (!hit[i] || segments.empty()) continue;
            const CommonSegment common = common_segment(pairs[i].a, pairs[i].b);
            segments[i] = {common.begin, common.end};
        }
    }
};

}  // namespace

KOLIZE_PLUGIN(Exact, .name = "exact",
              .summary = "exact triangle-triangle test: never a wrong answer, touching and coplanar too",
              .source = "Devillers & Guigue, INRIA RR-4488, 2002, over the predicates of Shewchuk, DCG 18, 1997",
              .cost =
                  "About 150 processor cycles a pair; where floating point leaves a sign in doubt, up to ten "
                  "microseconds for exact arithmetic. A segment, where the contact model asks for it, is computed "
                  "exactly, which takes as long.",
              .accuracy =
                  "No wrong answer for any finite corners as they come: triangles are closed, so that a touch "
                  "counts. The ends of a segment are within a few roundings of the exact ones.",
              .choose = "As the judge of other triangle tests, and wherever a wrong answer matters more than its time.",
              .capabilities = {.shape_kinds = all_shape_kinds | bit(ShapeKind::capsule),
                               .time_of_impact = true,
                               .exact = true,
                               .crossings = true})
