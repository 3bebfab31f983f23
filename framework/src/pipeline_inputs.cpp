// What comes to a pipeline between two steps: inputs, and the questions of whoever looks on.
#include "pipeline.h"

#include <stdexcept>

namespace kolize {

namespace {

void require_finite(bool finite, const char* what) {
    if (!finite) throw std::invalid_argument(std::string(what) + " must be finite");
}

}  // namespace

void Pipeline::require_dynamic(std::uint32_t body) const {
    if (body >= world.size())
        throw std::invalid_argument("there is no body " + std::to_string(body) + "; the last one is " +
                                    std::to_string(world.size() - 1));
    if (world.is_static[body]) throw std::invalid_argument("body " + body_text(world, body) + " is static");
}

void Pipeline::put_in(const ForcesInput& input) {
    const Forces& forces = input.forces;
    require_finite(forces.gravity.allFinite() && forces.wind.allFinite(), "gravity and wind");
    if (!(forces.drag >= 0 && forces.drag < infinity))
        throw std::invalid_argument("drag must be finite and not below 0");
    wake_all();
    measure.change(world, [&] { world.forces = forces; });
}

void Pipeline::put_in(const LoadInput& input) {
    require_dynamic(input.body);
    require_finite(input.force.allFinite() && input.torque.allFinite(), "force and torque");
    wake_all();
    measure.change(world, [&] {
        world.constant_force[input.body] = input.force;
        world.constant_torque[input.body] = input.torque;
    });
}

void Pipeline::put_in(const PlaceInput& input) {
    require_dynamic(input.body);
    const BodyState& state = input.state;
    require_finite(state.position.allFinite() && state.orientation.coeffs().allFinite() && state.velocity.allFinite() &&
                       state.angular_velocity.allFinite(),
                   "what a body is given");
    if (!(std::abs(state.orientation.norm() - 1) <= 1e-9))
        throw std::invalid_argument("an orientation must be a quaternion of length 1");
    wake_all();
    measure.change(world, [&] {
        world.set_state(input.body, state);
        world.removed[input.body] = 0;
    });
    number_rows();
}

void Pipeline::put_in(const RemoveInput& input) {
    require_dynamic(input.body);
    wake_all();
    measure.change(world, [&] { world.removed[input.body] = 1; });
    number_rows();
}

void Pipeline::take_over(const Pipeline& before) {
    for (std::uint32_t body = 0; body < scene_bodies_; ++body) {
        world.set_state(body, before.world.state(body));
        world.removed[body] = before.world.removed[body];
        world.constant_force[body] = before.world.constant_force[body];
        world.constant_torque[body] = before.world.constant_torque[body];
    }
    world.forces = before.world.forces;
    for (std::size_t i = 0; i < rules.size() && i < before.rules.size(); ++i) {
        if (rules[i].plugin != before.rules[i].plugin) continue;
        std::vector<std::uint64_t> words;
        before.rules[i].stage->save(words);
        rules[i].stage->restore(words);
    }
    first_step_ = before.step_number();
    number_rows();
    measure = Measure();
    measure.start(world, rooms_, expected_steps_);
    if (ledger) ledger.emplace(ledger_config_, world);
}

void Pipeline::save_memory(std::vector<ResponseMemory>& memory) const {
    memory.resize(rules.size());
    for (std::size_t i = 0; i < rules.size(); ++i) {
        memory[i].plugin = rules[i].plugin->descriptor->name;
        memory[i].words.clear();
        rules[i].stage->save(memory[i].words);
    }
}

// Of another plugin in its place nothing is kept.
void Pipeline::restore_memory(const Scene& scene) {
    for (std::size_t i = 0; i < scene.memory.size() && i < rules.size(); ++i) {
        const ResponseMemory& memory = scene.memory[i];
        if (memory.plugin != rules[i].plugin->descriptor->name) continue;
        try {
            rules[i].stage->restore(memory.words);
        } catch (const std::exception& error) {
            throw Error(scene.file + ": [[capsule.memory]] " + std::to_string(i) + " is not of response '" +
                        memory.plugin + "': " + error.what());
        }
    }
}

void Pipeline::outline(Outline& outline) const {
    if (broadphase_plugin->descriptor->capabilities.outline)
        broadphase->outline(broadphase_input(), outline);
}

void Pipeline::find_crossings(std::vector<CrossingLine>& crossings) const {
    if (!narrowphase_plugin->descriptor->capabilities.crossings) return;
    std::vector<Pair> there;
    for (const Pair& pair : pairs)
        if (!world.removed[pair.a] && !world.removed[pair.b]) there.push_back(pair);
    const std::vector<Detail> detail(there.size(), Detail::normal);
    narrowphase->find_crossings({world, there, detail}, crossings);
}

}  // namespace kolize
