#include "stepping.h"

#include "event_stepping.h"

#include <stdexcept>

namespace kolize {

namespace {

class Discrete final : public Stepping {
public:
    void step(Pipeline& pipeline, double dt) override {
        pipeline.integrate(dt);
        pipeline.detect();
        pipeline.respond(dt);
    }
};

class Rollback final : public Stepping {
public:
    void step(Pipeline& pipeline, double dt) override {
        pipeline.save();
        pipeline.integrate(dt);
        is_back_.assign(pipeline.world.size(), 0);
        // A body that goes back may stand where another one moved to: then that one goes back too, and so on.
        do {
            pipeline.detect();
            pipeline.respond(dt);
        } while (put_back_touching(pipeline));
    }

private:
    bool put_back_touching(Pipeline& pipeline) {
        bool any = false;
        for (const Contact& contact : pipeline.contacts.rows)
            for (const std::uint32_t body : {contact.a, contact.b}) {
                if (pipeline.world.is_static[body] || is_back_[body]) continue;
                pipeline.put_back(body);
                is_back_[body] = 1;
                any = true;
            }
        return any;
    }

    std::vector<std::uint8_t> is_back_;
};

}  // namespace

std::unique_ptr<Stepping> make_stepping(const StepConfig& config) {
    if (config.mode == "discrete") return std::make_unique<Discrete>();
    if (config.mode == "rollback") return std::make_unique<Rollback>();
    if (config.mode == "bisection") return make_bisection(config);
    if (config.mode == "continuous") return make_continuous(config);
    throw std::invalid_argument("step.mode must be discrete, rollback, bisection or continuous, is " + config.mode);
}

const std::vector<std::string>& stepping_names() {
    static const std::vector<std::string> names = {"discrete", "rollback", "bisection", "continuous"};
    return names;
}

}  // namespace kolize
