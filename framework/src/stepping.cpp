#include "stepping.h"

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

class Bisection final : public Stepping {
public:
    Bisection(double tolerance, int max_impacts) : tolerance_(tolerance), max_impacts_(max_impacts) {}

    void step(Pipeline& pipeline, double dt) override {
        double left = dt;
        for (int impact = 0; impact < max_impacts_; ++impact) {
            pipeline.save();
            advance(pipeline, left);
            if (!pipeline.approaching()) return pipeline.respond(left);
            const double taken = advance_to_impact(pipeline, left, tolerance_ * dt);
            pipeline.respond(taken);
            left -= taken;
            if (!(left > 0)) return;
        }
        advance(pipeline, left);
        pipeline.respond(left);
    }

private:
    static void advance(Pipeline& pipeline, double time) {
        pipeline.integrate(time);
        pipeline.detect();
    }

    // Leaves the world where something begins to approach in contact, found to the tolerance. Returns the time taken.
    static double advance_to_impact(Pipeline& pipeline, double time, double tolerance) {
        double before = 0, after = time;
        while (after - before > tolerance) {
            const double middle = 0.5 * (before + after);
            pipeline.restore();
            advance(pipeline, middle);
            (pipeline.approaching() ? after : before) = middle;
        }
        pipeline.restore();
        advance(pipeline, after);
        return after;
    }

    double tolerance_;
    int max_impacts_;
};

}  // namespace

std::unique_ptr<Stepping> make_stepping(const StepConfig& config) {
    if (config.mode == "discrete") return std::make_unique<Discrete>();
    if (config.mode == "rollback") return std::make_unique<Rollback>();
    if (config.mode == "bisection") return std::make_unique<Bisection>(config.tolerance, config.max_impacts);
    throw std::invalid_argument("step.mode must be discrete, rollback or bisection, is " + config.mode);
}

}  // namespace kolize
