// Overlays: what a stage did in the last step, as lines over a picture. Nothing is computed for one that is not shown.
#pragma once

#include <kolize/renderer.h>
#include <kolize/simulation.h>

#include <optional>
#include <string>
#include <vector>

namespace kolize::cli {

// What is known of an overlay without a simulation.
struct OverlayText {
    const char* name;
    const char* shows;
    const char* needs;  // of the pipeline; "nothing" where every pipeline will do
};

const std::vector<OverlayText>& overlay_texts();

// Why this pipeline cannot show it, in a sentence that names plugins that would do; "" if it can.
std::string overlay_refusal(const std::string& name, const Simulation& simulation, const PluginLibrary& plugins);

class Overlays {
public:
    // "bounds,pairs,spheres:3": names, and for those with levels (cells, planes, spheres) the one that is wanted. "" is
    // none. Throws Error for a name that is not known.
    explicit Overlays(const std::string& names = "");

    bool is_shown(const std::string& name) const;
    void show(const std::string& name, bool shown);
    // Throws Error for the first one that this pipeline cannot show.
    void require(const Simulation& simulation, const PluginLibrary& plugins) const;
    // Appends the lines of all that are shown and that this pipeline can show.
    void draw(const Simulation& simulation, const PluginLibrary& plugins, std::vector<Line>& lines) const;

private:
    struct Shown {
        std::string name;
        std::optional<std::uint32_t> level;
    };
    std::vector<Shown> shown_;
};

}  // namespace kolize::cli
