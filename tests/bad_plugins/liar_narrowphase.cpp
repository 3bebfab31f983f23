// Loads and claims manifolds, and then gives a row for every pair whose normal is no direction, moves what it may only
// look at, or throws over one body.
#include <kolize/plugin.h>

#include <stdexcept>

namespace {

class Liar final : public kolize::Narrowphase {
public:
    static void parameters(kolize::Parameters<Liar>& p) {
        p.add("normal", &Liar::normal_).choices({"zero", "nan"}).doc("What every component of the normal is.");
        p.add("moves", &Liar::moves_).doc("Moves the first body of each pair, and reports no contact.");
        p.add("fails_at", &Liar::fails_at_).doc("Throws over pairs with this body, and reports no contact.");
    }

    kolize::Detail gives() const override { return kolize::Detail::manifold; }
    void prepare(const kolize::World&) override {}

    void find_contacts(const kolize::NarrowphaseInput& input, kolize::Contacts& contacts) override {
        const double component = normal_ == "nan" ? std::numeric_limits<double>::quiet_NaN() : 0;
        for (const kolize::Pair pair : input.pairs) {
            if (moves_) const_cast<kolize::World&>(input.world).position[pair.a].z() += 0.125;
            if (fails_at_ == static_cast<int>(pair.a)) throw std::runtime_error("no luck today");
            if (moves_ || fails_at_ >= 0) continue;
            kolize::Contact& row = contacts.rows.emplace_back();
            row.a = pair.a;
            row.b = pair.b;
            row.normal = kolize::Vec3::Constant(component);
            row.depth = 0.1;
        }
    }

private:
    std::string normal_ = "zero";
    bool moves_ = false;
    int fails_at_ = -1;
};

}  // namespace

KOLIZE_PLUGIN(Liar, .name = "liar", .summary = "normals that are no directions", .source = "none")
