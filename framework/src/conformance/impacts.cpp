#include "impacts.h"

#include <algorithm>
#include <random>
#include <sstream>
#include <tuple>

namespace kolize {

namespace {

class Dice {
public:
    explicit Dice(std::uint64_t seed) : random_(seed) {}

    Vec3 vector() {
        const double x = normal_(random_), y = normal_(random_), z = normal_(random_);
        return {x, y, z};
    }
    double uniform(double min, double max) { return std::uniform_real_distribution<double>(min, max)(random_); }
    std::uint32_t below(std::size_t count) { return static_cast<std::uint32_t>(random_() % count); }

private:
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_;
};

BodyDescription random_body(Dice& dice, bool is_static) {
    BodyDescription body;
    body.is_static = is_static;
    body.mass = dice.uniform(0.1, 10);
    body.position = dice.vector();
    const Vec3 axis = dice.vector().normalized();
    body.orientation = Quat(Eigen::AngleAxisd(dice.uniform(-3, 3), axis));
    if (is_static) return body;
    body.velocity = dice.vector();
    body.angular_velocity = dice.vector();
    return body;
}

Contact random_contact(Dice& dice, const World& world, std::uint32_t a, std::uint32_t b, Detail detail) {
    Contact contact;
    contact.a = std::min(a, b);
    contact.b = std::max(a, b);
    if (detail == Detail::overlap) return contact;
    const Vec3 point = dice.vector();
    contact.normal = dice.vector().normalized();
    contact.arm_a = point - world.position[contact.a];
    contact.arm_b = point - world.position[contact.b];
    contact.depth = dice.uniform(0, 0.1);
    return contact;
}

// The contact and its hit bits between bodies with new numbers.
std::pair<Contact, std::uint8_t> renumbered(Contact contact, std::uint8_t hit,
                                            const std::vector<std::uint32_t>& number) {
    contact.a = number[contact.a];
    contact.b = number[contact.b];
    if (contact.a < contact.b) return {contact, hit};
    std::swap(contact.a, contact.b);
    std::swap(contact.arm_a, contact.arm_b);
    contact.normal = -contact.normal;
    return {contact, static_cast<std::uint8_t>((hit & 1) << 1 | hit >> 1)};
}

}  // namespace

ImpactScene random_impacts(std::size_t count, Detail detail, double restitution, std::uint64_t seed) {
    Dice dice(seed);
    ImpactScene scene;
    World& world = scene.world;
    world.materials.push_back({"material", restitution, 0, 1000});
    world.shapes.push_back(make_box("box", Vec3(0.3, 0.5, 0.7)));
    for (std::size_t i = 0; i < 2 * count + 2; ++i) world.add(random_body(dice, i % 4 == 0));
    while (scene.contacts.size() < count) {
        const std::uint32_t a = dice.below(world.size()), b = dice.below(world.size());
        if (a == b || (world.is_static[a] && world.is_static[b])) continue;
        scene.contacts.push_back(random_contact(dice, world, a, b, detail));
        scene.hit.push_back(static_cast<std::uint8_t>(1 + dice.below(3)));
    }
    std::stable_sort(scene.contacts.begin(), scene.contacts.end(), [](const Contact& c, const Contact& d) {
        return Pair{c.a, c.b} < Pair{d.a, d.b};
    });
    return scene;
}

ImpactScene moved(const ImpactScene& scene, const Quat& turn, const Vec3& shift) {
    ImpactScene result = scene;
    World& world = result.world;
    for (std::size_t i = 0; i < world.size(); ++i) {
        world.position[i] = turn * world.position[i] + shift;
        world.orientation[i] = turn * world.orientation[i];
        world.velocity[i] = turn * world.velocity[i];
        world.angular_velocity[i] = turn * world.angular_velocity[i];
    }
    for (Contact& contact : result.contacts) {
        contact.normal = turn * contact.normal;
        contact.arm_a = turn * contact.arm_a;
        contact.arm_b = turn * contact.arm_b;
    }
    return result;
}

ImpactScene renumbered(const ImpactScene& scene, const std::vector<std::uint32_t>& number) {
    ImpactScene result = scene;
    World& world = result.world;
    for (std::uint32_t i = 0; i < number.size(); ++i) {
        const std::uint32_t j = number[i];
        world.set_state(j, scene.world.state(i));
        world.inverse_mass[j] = scene.world.inverse_mass[i];
        world.inverse_inertia[j] = scene.world.inverse_inertia[i];
        world.shape[j] = scene.world.shape[i];
        world.material[j] = scene.world.material[i];
        world.kind[j] = scene.world.kind[i];
        world.is_static[j] = scene.world.is_static[i];
    }
    std::vector<std::pair<Contact, std::uint8_t>> rows;
    for (std::size_t i = 0; i < scene.contacts.size(); ++i)
        rows.push_back(renumbered(scene.contacts[i], scene.hit[i], number));
    std::stable_sort(rows.begin(), rows.end(), [](const auto& r, const auto& s) {
        return Pair{r.first.a, r.first.b} < Pair{s.first.a, s.first.b};
    });
    for (std::size_t i = 0; i < rows.size(); ++i) std::tie(result.contacts[i], result.hit[i]) = rows[i];
    return result;
}

ImpactScene mirrored(const ImpactScene& scene) {
    const Vec3 mirror(-1, 1, 1);
    ImpactScene image = scene;
    World& world = image.world;
    for (std::size_t i = 0; i < world.size(); ++i) {
        const Quat q = world.orientation[i];
        world.position[i] = mirror.cwiseProduct(world.position[i]);
        world.orientation[i] = Quat(q.w(), q.x(), -q.y(), -q.z());
        world.velocity[i] = mirror.cwiseProduct(world.velocity[i]);
        world.angular_velocity[i] = -mirror.cwiseProduct(world.angular_velocity[i]);  // as every axial vector
    }
    for (Contact& contact : image.contacts)
        for (Vec3* v : {&contact.normal, &contact.arm_a, &contact.arm_b}) *v = mirror.cwiseProduct(*v);
    return image;
}

ImpactScene heavier(const ImpactScene& scene, double by) {
    ImpactScene result = scene;
    for (double& inverse : result.world.inverse_mass) inverse /= by;
    for (Vec3& inverse : result.world.inverse_inertia) inverse /= by;
    return result;
}

std::string to_text(const ImpactScene& scene) {
    const Eigen::IOFormat row(Eigen::FullPrecision, Eigen::DontAlignCols, ", ", ", ", "", "", "{", "}");
    std::ostringstream text;
    for (const Contact& c : scene.contacts) {
        text << "contact {.a = " << c.a << ", .b = " << c.b << ", .normal = " << c.normal.format(row)
             << ", .arm_a = " << c.arm_a.format(row) << ", .arm_b = " << c.arm_b.format(row) << "} ";
        for (const std::uint32_t body : {c.a, c.b})
            text << "body " << body << (scene.world.is_static[body] ? " static" : "")
                 << " {.inverse_mass = " << scene.world.inverse_mass[body]
                 << ", .velocity = " << scene.world.velocity[body].format(row)
                 << ", .angular_velocity = " << scene.world.angular_velocity[body].format(row) << "} ";
    }
    return text.str();
}

}  // namespace kolize
