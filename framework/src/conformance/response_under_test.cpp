#include "response_under_test.h"

namespace kolize {

void ResponseUnderTest::expect_same(const World& got, const World& expected, const std::string& what,
                                    const ImpactScene& scene) {
    for (std::size_t i = 0; i < got.size(); ++i)
        if (!same_bits(got.velocity[i], expected.velocity[i]) ||
            !same_bits(got.angular_velocity[i], expected.angular_velocity[i]))
            violate(what + ": body " + std::to_string(i) + " moves otherwise", scene);
}

StagePtr<Response> ResponseUnderTest::make(Host& host, const Settings& settings) const {
    StageConfig config = default_config(plugin_);
    config.settings = settings;
    return library_.make<Response>(config, host);
}

ResponseUnderTest::Answer ResponseUnderTest::respond(Response& stage, const ImpactScene& scene, double settle) {
    Answer answer{scene, {}, 0, 0};
    ResponseOutput output{answer.events};
    stage.respond({answer.scene.contacts, answer.scene.hit, 0.01, settle}, answer.scene.world, output);
    answer.dissipated_J = output.dissipated_J;
    answer.unresolved = output.unresolved;
    return answer;
}

ResponseUnderTest::Answer ResponseUnderTest::respond(const ImpactScene& scene, double settle) const {
    const auto host = make_host(1);
    return respond(*make(*host), scene, settle);
}

}  // namespace kolize
