// Not wrong, only modest: says which spheres may overlap, and no more.
#include <kolize/plugin.h>

namespace {

class OverlapOnly final : public kolize::Narrowphase {
public:
    kolize::Detail gives() const override { return kolize::Detail::overlap; }
    void prepare(const kolize::World&) override {}

    void find_contacts(const kolize::NarrowphaseInput& input, kolize::Contacts& contacts) override {
        for (const kolize::Pair pair : input.pairs) {
            kolize::Contact& row = contacts.rows.emplace_back();
            row.a = pair.a;
            row.b = pair.b;
        }
    }
};

}  // namespace

KOLIZE_PLUGIN(OverlapOnly, .name = "overlap_only", .summary = "bounds are all it looks at", .source = "none",
              .capabilities = {.shape_kinds = kolize::bit(kolize::ShapeKind::sphere), .gives = kolize::Detail::overlap})
