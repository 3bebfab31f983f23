// Times of impact: fast bodies and thin plates, near misses, and rods that turn, against closed forms.
#include "stability/study.h"

#include <kolize/flow.h>
#include <kolize/narrowphase.h>

#include <algorithm>

namespace kolize::cli::stability {
namespace {

constexpr int rounds = 12;
constexpr double dt = 1.0 / 60;  // s
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr std::size_t most_looks = 200000;  // at where a body is, for one pair; a few hundred are usual

// Constant velocities, which all closed forms here are of. Counts how often it is asked.
class CountedFlow final : public Flow {
public:
    explicit CountedFlow(const World& world) : world_(world) {}

    BodyState at(std::uint32_t body, double time) const override {
        if (++looks_ > most_looks)
            throw Hang("it looks at the motion of one pair more than " + std::to_string(most_looks) + " times");
        BodyState state = world_.state(body);
        state.position += time * state.velocity;
        const double speed = state.angular_velocity.norm();
        if (speed > 0)
            state.orientation =
                Quat(Eigen::AngleAxisd(speed * time, state.angular_velocity / speed)) * state.orientation;
        return state;
    }
    MotionBound bound(std::uint32_t body) const override {
        MotionBound bound;
        bound.angular_speed = world_.angular_velocity[body].norm();
        return bound;
    }

private:
    const World& world_;
    mutable std::size_t looks_ = 0;
};

std::uint32_t add(World& world, Shape shape, const Vec3& position, const Quat& orientation, const Vec3& velocity) {
    BodyDescription body;
    body.shape = static_cast<std::uint32_t>(world.shapes.size());
    world.shapes.push_back(std::move(shape));
    body.mass = 1;
    body.position = position;
    body.orientation = orientation;
    body.velocity = velocity;
    return world.add(body);
}

double first_impact(const Context& context, const Subject& subject, const World& world) {
    const auto stage = context.plugins.make<Narrowphase>(subject.config, context.host);
    stage->prepare(world);
    const Pair pair{0, 1};
    double time = 0;
    stage->find_impacts({world, CountedFlow(world), {&pair, 1}, 0, dt}, {&time, 1});
    return time;
}

// `gap_at(time)`: between the surfaces, below 0 where they overlap; `true_time`: when they meet, infinity if they do
// not; `deepest`: the overlap if nothing is found. `rounding` (m): what positions along the way cannot tell.
template <class GapAt>
Outcome judge(const World& world, double time, double true_time, double deepest, double rounding, GapAt&& gap_at) {
    if (std::isnan(time)) return {Failure::not_finite, "the time of impact is not a number"};
    const double near = 2 * touch_distance(world, 0, 1) + rounding;
    if (!(time < infinity)) {
        if (!(true_time < dt) || deepest <= near) return {};
        return {Failure::missed, "the impact after " + number(true_time / dt) + " dt is missed"};
    }
    const double gap = gap_at(time);
    if (gap < -rounding)
        return {Failure::late, "at the time of impact the bodies overlap by " + number(-gap) + " m already"};
    if (gap > near)
        return {true_time < infinity ? Failure::inaccurate : Failure::wrong,
                "at the time of impact the bodies are " + number(gap) + " m apart"};
    return {};
}

template <class Round>
Outcome all_rounds(const Context& context, Round&& round) {
    Dice dice(context.seed);
    for (int i = 0; i < rounds; ++i)
        if (const Outcome outcome = round(dice); !outcome.holds()) return outcome;
    return {};
}

Mat3 turn_of(Dice& dice) { return dice.below(2) ? Mat3(Mat3::Identity()) : dice.rotation().toRotationMatrix(); }

// --- A ball flies at a plate ---------------------------------------------------------------------------------------

enum { speed, distance };

Outcome plate(const Context& context, const Subject& subject, const Point& point) {
    constexpr double radius = 0.1, thickness = 1e-3;  // m
    return all_rounds(context, [&](Dice& dice) {
        const Mat3 turn = turn_of(dice);
        const Vec3 origin = value(point, distance) * dice.direction(), up = turn.col(1);
        const double way = value(point, speed) * thickness;  // in one step
        const double gap = dice.between(0.05, 0.95) * way;
        World world;
        world.materials.emplace_back();
        add(world, make_box("plate", Vec3(1, thickness / 2, 1)), origin, Quat(turn), Vec3::Zero());
        const Vec3 over = turn * Vec3(dice.between(-0.5, 0.5), 0, dice.between(-0.5, 0.5));
        add(world, make_sphere("ball", radius), origin + over + (thickness / 2 + radius + gap) * up, Quat::Identity(),
            -way / dt * up);
        const double start = (world.position[1] - world.position[0]).dot(up) - thickness / 2 - radius;
        const double closing = -world.velocity[1].dot(up);
        const double rounding = 16 * epsilon * (value(point, distance) + way + 1);
        return judge(world, first_impact(context, subject, world), start / closing, way, rounding,
                     [&](double time) { return start - closing * time; });
    });
}

// --- Two balls that graze each other -------------------------------------------------------------------------------

enum { graze = 2 };

Outcome balls(const Context& context, const Subject& subject, const Point& point) {
    constexpr double reach = 0.5;  // m, of both radii
    return all_rounds(context, [&](Dice& dice) {
        const Mat3 turn = turn_of(dice);
        const Vec3 origin = value(point, distance) * dice.direction();
        const double way = value(point, speed) * reach;
        const double aside = reach * (1 + (dice.below(2) ? 1 : -1) * value(point, graze) * 0.5);
        World world;
        world.materials.emplace_back();
        add(world, make_sphere("still", 0.3), origin, Quat::Identity(), Vec3::Zero());
        add(world, make_sphere("fast", 0.2), origin + turn * Vec3(-0.5 * way - reach, aside, 0), Quat::Identity(),
            turn * Vec3((way + 2 * reach) / dt, 0, 0));
        using Long = long double;
        const Eigen::Matrix<Long, 3, 1> d = (world.position[1] - world.position[0]).cast<Long>(),
                                        v = world.velocity[1].cast<Long>();
        const Long closest = d.cross(v).norm() / v.norm();
        const Long half = std::sqrt(std::max<Long>(0, reach * reach - closest * closest));
        const double when = closest < reach ? static_cast<double>((-d.dot(v) / v.norm() - half) / v.norm()) : infinity;
        const double rounding = 16 * epsilon * (value(point, distance) + way + 1);
        return judge(world, first_impact(context, subject, world), when, static_cast<double>(reach - closest), rounding,
                     [&](double time) { return static_cast<double>((d + Long(time) * v).norm() - Long(reach)); });
    });
}

// --- A rod turns onto the ground -----------------------------------------------------------------------------------

enum { spin };

Outcome rod(const Context& context, const Subject& subject, const Point& point) {
    constexpr double half_length = 1, half_width = 0.01;  // m
    return all_rounds(context, [&](Dice& dice) {
        const Vec3 origin = value(point, distance) * dice.direction();
        const double height = dice.between(0.2, 0.9), rate = value(point, spin) / dt;
        World world;
        world.materials.emplace_back();
        add(world, make_box("ground", Vec3(3, 0.5, 3)), origin, Quat::Identity(), Vec3::Zero());
        const std::uint32_t body = add(world, make_box("rod", Vec3(half_length, half_width, half_width)),
                                       origin + Vec3(0, 0.5 + height, 0), Quat::Identity(), Vec3::Zero());
        world.angular_velocity[body] = Vec3(0, 0, rate);
        const double above = (world.position[1] - world.position[0]).y() - 0.5;
        const double reach = std::hypot(half_length, half_width);
        const double angle = std::asin(above / reach) - std::atan2(half_width, half_length);
        const double rounding = 16 * epsilon * (value(point, distance) + 3);
        return judge(
            world, first_impact(context, subject, world), angle / rate, reach - above, rounding, [&](double time) {
                const double turned = rate * time;
                return above - half_length * std::abs(std::sin(turned)) - half_width * std::abs(std::cos(turned));
            });
    });
}

}  // namespace

std::vector<Study> continuous_studies(const Context& context, const std::vector<Subject>& narrowphases) {
    std::vector<Subject> subjects;
    std::vector<std::string> left_out;
    for (const Subject& subject : narrowphases)
        if (subject.plugin->descriptor->capabilities.time_of_impact)
            subjects.push_back(subject);
        else
            left_out.push_back(subject.name + ": it finds no times of impact");
    const std::string judged =
        " Neither missed nor late, and early by no more than twice the touch distance, as far as positions along the "
        "way can be told apart. Oracle: closed form.";
    const Axis away{"distance", "m", "from the origin", 0, 15, 0};
    return {{"continuous",
             "plate",
             "A ball of 0.2 m flies at a plate of 1 mm, 12 times, half of them turned." + judged,
             {{"speed", "", "way in one step over the thickness", -3, 12, 2}, away},
             subjects,
             [context](const Subject& subject, const Point& point) { return plate(context, subject, point); },
             left_out},
            {"continuous",
             "graze",
             "Two balls that reach 0.5 m pass each other, 12 times." + judged,
             {{"speed", "", "way in one step over the reach", -3, 12, 1},
              away,
              {"graze", "", "by how much of the reach they hit or miss, doubled", 0, -16, 0}},
             subjects,
             [context](const Subject& subject, const Point& point) { return balls(context, subject, point); },
             left_out},
            {"continuous",
             "rod",
             "A rod of 2 m turns onto flat ground, 12 times." + judged,
             {{"spin", "rad", "turn in one step", -1, 4, 0.3}, away},
             subjects,
             [context](const Subject& subject, const Point& point) { return rod(context, subject, point); },
             left_out}};
}

}  // namespace kolize::cli::stability
