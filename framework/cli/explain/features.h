// What a pipeline models of a scene and what it leaves out, with the fact of the scene that decided it.
#pragma once

#include "common.h"

namespace kolize::cli {

struct Feature {
    std::string name;
    bool modelled = false;
    std::string because;     // the deciding fact
    std::string wrong_when;  // when leaving it out, or doing it that way, would be wrong; "" if never
    Settings other;          // that do it the other way, for measuring; empty where there is no such switch
};

// Of a simulation that has run for a while.
std::vector<Feature> features_of(const Scene& scene, const Simulation& simulation, const PluginLibrary& plugins);

// Settings under which everything is modelled that can be.
Settings all_modelled();

}  // namespace kolize::cli
