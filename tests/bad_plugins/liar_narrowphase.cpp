// Loads and claims manifolds, and then gives a row for every pair whose normal is no direction.
#include <kolize/plugin.h>

namespace {

class Liar final : public kolize::Narrowphase {
public:
    static void parameters(kolize::Parameters<Liar>& p) {
        p.add("normal", &Liar::normal_).choices({"zero", "nan"}).doc("What every component of the normal is.");
    }

    kolize::Detail gives() const override { return kolize::Detail::manifold; }
    void prepare(const kolize::World&) override {}

    void find_contacts(const kolize::NarrowphaseInput& input, kolize::Contacts& contacts) override {
        const double component = normal_ == "nan" ? std::numeric_limits<double>::quiet_NaN() : 0;
        for (const kolize::Pair pair : input.pairs) {
            kolize::Contact& row = contacts.rows.emplace_back();
            row.a = pair.a;
            row.b = pair.b;
            row.normal = kolize::Vec3::Constant(component);
            row.depth = 0.1;
        }
    }

private:
    std::string normal_ = "zero";
};

}  // namespace

KOLIZE_PLUGIN(Liar, .name = "liar", .summary = "normals that are no directions", .source = "none")
