// A whole, small broadphase that the fixture libraries are made of: one parameter of every type, no interest in speed.
#pragma once

#include <kolize/plugin.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace fixture {

class Fixture final : public kolize::Broadphase {
public:
    static void parameters(kolize::Parameters<Fixture>& p) {
        p.add("strict", &Fixture::strict_).doc("Leave out boxes that only touch.");
        p.add("passes", &Fixture::passes_).range(1, 8).doc("How often to look.");
        p.add("cell_size", &Fixture::cell_size_).unit("m").range(0, 1e9).doc("Side of a cell.");
        p.add("precision", &Fixture::precision_).choices({"float", "double"}).doc("Type of the coordinates.");
    }

    void attach(kolize::Host& host) override {
        if (precision_ == "float" && cell_size_ > 1e6)
            throw std::invalid_argument("cell_size above 1e6 m needs precision = \"double\"");
        Broadphase::attach(host);
    }

    void find_pairs(const kolize::BroadphaseInput& input, std::vector<kolize::Pair>& pairs) override {
        for (std::uint32_t b = 0; b < input.bounds.size(); ++b)
            for (std::uint32_t a = 0; a < b; ++a)
                if (input.bounds[a].overlaps(input.bounds[b])) pairs.push_back({a, b});
    }

private:
    bool strict_ = false;
    int passes_ = 2;
    double cell_size_ = 1;
    std::string precision_ = "double";
};

inline constexpr kolize::PluginText text{
    .name = "fixture", .summary = "every overlapping pair", .source = "none", .capabilities = {}};

}  // namespace fixture
