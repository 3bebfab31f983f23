// What the plugin boundary itself costs: calls through it that find nothing to do, against a step of box_objects.
#include <kolize/simulation.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

using namespace kolize;

namespace {

constexpr int rounds = 21;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class Measure>
double median_of_rounds(Measure&& measure) {
    std::vector<double> values;
    for (int i = 0; i < rounds; ++i) values.push_back(measure());
    std::nth_element(values.begin(), values.begin() + rounds / 2, values.end());
    return values[rounds / 2];
}

// Nanoseconds for one call of each stage kind, all with empty input.
double empty_calls_ns(const Scene& scene, const PluginLibrary& plugins, Host& host) {
    const auto broadphase = plugins.make<Broadphase>(scene.pipeline.broadphase, host);
    const auto narrowphase = plugins.make<Narrowphase>(scene.pipeline.narrowphase, host);
    const auto response = plugins.make<Response>(scene.pipeline.responses.at(0).stage, host);
    World world;
    narrowphase->prepare(world);
    std::vector<Pair> pairs;
    Contacts contacts;
    std::vector<Event> events;
    ResponseOutput output{events};
    constexpr int calls = 1000000;
    return median_of_rounds([&] {
        const auto start = std::chrono::steady_clock::now();
        for (int i = 0; i < calls; ++i) {
            broadphase->find_pairs({}, pairs);
            narrowphase->find_contacts({world, {}, {}}, contacts);
            response->respond({}, world, output);
        }
        return seconds_since(start) / calls * 1e9;
    });
}

double step_ns(const Scene& scene, const PluginLibrary& plugins, Host& host) {
    constexpr std::uint64_t steps = 2400;
    return median_of_rounds([&] {
        Simulation simulation(scene, plugins, host, steps);
        for (std::uint64_t i = 0; i < steps; ++i) simulation.step();
        return simulation.result().step.median_us * 1e3;
    });
}

}  // namespace

int main() {
    const PluginLibrary plugins({KOLIZE_PLUGIN_DIR});
    const auto host = make_host(1);
    const Scene scene = load_scene(KOLIZE_SOURCE_DIR "/demos/box_objects/scene.toml", {}, plugins);
    const double calls = empty_calls_ns(scene, plugins, *host), step = step_ns(scene, plugins, *host);
    std::printf("three stage calls with nothing to do %8.1f ns\n", calls);
    std::printf("median step of box_objects           %8.1f ns\n", step);
    std::printf("share of the step                    %8.2f %%\n", 100 * calls / step);
}
