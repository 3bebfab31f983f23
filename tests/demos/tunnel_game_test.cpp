#include "demos/tunnel_games.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

WindowEvent event_of(WindowEventKind kind, double x = 0, double y = 0) {
    WindowEvent event;
    event.kind = kind;
    event.x = x, event.y = y;
    return event;
}

const TunnelScene& three_cubes() {
    static const TunnelScene tunnel = tunnel_of(short_tunnel);
    return tunnel;
}

// The same with a crate before the fighter, 40 m from its centre to the crate's.
const TunnelScene& with_crate() {
    static const TunnelScene tunnel = tunnel_of(
        "S (0 0 0)(0 1 0) 1.0 END END  I (0 0 -1)(0 0 1) 0 END models/crate.obj (0 0 0)(0 0 1) 0 END  "
        "S (0 0 -2)(0 0 1) 0 END END");
    return tunnel;
}

Player flying(const TunnelScene& tunnel) {
    Player player(tunnel);
    player.press(Key::enter);
    return player;
}

std::size_t missiles_in(const Player& player) {
    std::size_t count = 0;
    for (const std::uint32_t missile : player.game.tunnel().missiles) count += !player.world().removed[missile];
    return count;
}

}  // namespace

TEST_CASE("On the start screen the world stands still until Enter", "[tunnel]") {
    Player player(three_cubes());
    player.down('W');
    player.wait(1);
    CHECK(player.game.phase() == Phase::ready);
    CHECK(player.session.simulation().step_number() == 0);
    CHECK(player.session.time() == Approx(1));
    player.press(Key::enter);
    player.wait(1);
    CHECK(player.game.phase() == Phase::flying);
    CHECK(player.game.flight_time() == Approx(1));
    CHECK(player.velocity().z() == Approx(-20).epsilon(0.01));  // 20 m/s^2 for 1 s
}

TEST_CASE("A flight is finished when the fighter's centre is in the last cube, and Enter goes on to the next",
          "[tunnel]") {
    Player player(std::vector<TunnelScene>{three_cubes(), with_crate()});
    player.press(Key::enter);
    player.down('W');
    // From the middle of the first cube to the border of the last: 60 m at 20 m/s^2 take sqrt(6) s.
    player.wait(2.4);
    CHECK(player.game.phase() == Phase::flying);
    CHECK(player.game.cell() == 1);
    player.wait(0.1);
    CHECK(player.game.phase() == Phase::arrived);
    REQUIRE(player.game.reports().size() == 1);
    CHECK(player.game.reports()[0].time == Approx(std::sqrt(6)).margin(0.02));
    player.up('W');
    player.wait(6);  // it stops there, and may bounce off the wall
    CHECK(player.velocity().norm() < 0.01);
    CHECK(player.game.cell() == 2);
    player.press(Key::enter);
    player.wait(0.5);
    CHECK(player.game.phase() == Phase::flying);
    CHECK(player.game.tunnel_number() == 1);
    CHECK(player.game.cell() == 0);
    CHECK(player.game.flight_time() == Approx(0.5));
    CHECK(player.game.reports().size() == 1);
    player.press(Key::escape);
    CHECK(player.game.phase() == Phase::ended);
}

TEST_CASE("After the last tunnel the game is done", "[tunnel]") {
    Player player = flying(three_cubes());
    player.down('W');
    player.wait(2.6);
    CHECK(player.game.phase() == Phase::done);
    player.press(Key::enter);
    player.wait(0.1);
    CHECK(player.game.phase() == Phase::done);
    CHECK(player.game.reports().size() == 1);
    player.game.take(event_of(WindowEventKind::closed));
    CHECK(player.game.phase() == Phase::ended);
}

TEST_CASE("Relative control keeps the velocity, the autopilot and full stop take it away", "[tunnel]") {
    for (const char control : {'1', '2'}) {
        Player player = flying(three_cubes());
        player.press(control);
        player.down('W');
        player.wait(0.5);
        player.up('W');
        const double speed = player.velocity().norm();
        CHECK(speed > 9);
        player.wait(1.4);
        if (control == '1') CHECK(player.velocity().norm() == Approx(speed).epsilon(1e-9));
        if (control == '2') CHECK(player.velocity().norm() < 0.05);
        player.down(Key::space);
        player.wait(1.5);
        CHECK(player.velocity().norm() < 0.05);
    }
}

TEST_CASE("The fighter turns about its own axes and flies where its nose points", "[tunnel]") {
    Player player = flying(three_cubes());
    player.down(Key::left);
    player.wait(0.8);
    player.up(Key::left);
    player.wait(1.5);
    const Quat axes = axes_of(player.world(), player.fighter());
    const Vec3 nose = axes * Vec3::UnitX();
    CHECK(nose.x() < -0.5);            // left of -z
    CHECK(std::abs(nose.y()) < 0.05);  // yaw is not quite a principal axis of the fighter
    player.down('W');
    player.wait(0.3);
    CHECK(player.velocity().normalized().dot(nose) > 0.999);
}

TEST_CASE("Gravity and drag are put into the world and taken out again", "[tunnel]") {
    Player player = flying(three_cubes());
    player.press(Key::down);  // without G nothing comes of it but a turn
    player.wait(0.1);
    CHECK(player.world().forces.gravity.isZero(0));
    player.down('G');
    player.press(Key::down);
    player.wait(0.1);
    CHECK(player.world().forces.gravity == Vec3(0, -9.81, 0));
    player.press(Key::up);
    player.up('G');
    player.down('T');
    player.wait(1);
    player.up('T');
    CHECK(player.world().forces.gravity.isZero(0));
    CHECK(player.world().forces.drag == Approx(0.4));
    player.down('R');
    player.wait(2);
    CHECK(player.world().forces.drag == 0);
}

TEST_CASE("Missiles leave the nose 80 m/s faster than the fighter, four a second, and are gone after 4 s", "[tunnel]") {
    // Long enough for a missile to fly for 4 s.
    std::string text = "S (0 0 0)(0 1 0) 1.0 END END\n";
    for (int i = 1; i < 20; ++i) text += "I (0 0 -" + std::to_string(i) + ")(0 0 1) 0 END END\n";
    Player player = flying(tunnel_of(text + "S (0 0 -20)(0 0 1) 0 END END"));
    player.down('D');
    player.wait(0.25);
    player.up('D');
    const Vec3 velocity = player.velocity();
    player.down('F');
    player.wait(player.dt());
    REQUIRE(missiles_in(player) == 1);
    const std::uint32_t missile = player.game.tunnel().missiles[0];
    CHECK((player.world().velocity[missile] - velocity - Vec3(0, 0, -80)).norm() < 1e-9);
    const double before_nose = player.position().z() - fighter_length / 2 - player.world().position[missile].z();
    CHECK(before_nose > 0.6);
    CHECK(before_nose < 3);
    player.wait(0.99 - player.dt());
    CHECK(player.game.magazine().fired() == 4);
    player.up('F');
    player.wait(3 - 0.1);
    CHECK(missiles_in(player) == 4);
    player.wait(0.2);  // the first is 4 s old
    CHECK(missiles_in(player) == 3);
    player.wait(0.75);
    CHECK(missiles_in(player) == 0);
    CHECK(player.game.explosions() == 0);
    CHECK(player.game.magazine().left() == missiles_at_once);
}

TEST_CASE("No more missiles fly at once than there are", "[tunnel]") {
    std::string text = "S (0 0 0)(0 1 0) 1.0 END END\n";
    for (int i = 1; i < 20; ++i) text += "I (0 0 -" + std::to_string(i) + ")(0 0 1) 0 END END\n";
    Player player = flying(tunnel_of(text + "S (0 0 -20)(0 0 1) 0 END END"));
    player.down('F');
    player.wait(3.5);
    CHECK(player.game.magazine().fired() == missiles_at_once);
    CHECK(missiles_in(player) == missiles_at_once);
    player.wait(0.6);  // the first one's 4 s are over: its body flies again
    CHECK(player.game.magazine().fired() > missiles_at_once);
    CHECK(missiles_in(player) <= missiles_at_once);
}

TEST_CASE("A missile explodes at what it hits, once, and the fighter feels nothing of it", "[tunnel]") {
    Player player = flying(with_crate());
    player.down('F');
    player.wait(0.1);
    player.up('F');
    // From the nose to the crate: 40 m less the fighter's half, the clearance and the crate's half, at 80 m/s.
    player.wait(0.25);
    CHECK(player.game.explosions() == 0);
    player.wait(0.25);
    CHECK(player.game.explosions() == 1);
    CHECK(missiles_in(player) == 0);
    CHECK(player.velocity().norm() < 1e-9);
    player.wait(1);
    CHECK(player.game.explosions() == 1);
}

TEST_CASE("The left button fires too", "[tunnel]") {
    Player player = flying(with_crate());
    player.game.take(event_of(WindowEventKind::button_down));
    player.wait(0.1);
    player.game.take(event_of(WindowEventKind::button_up));
    player.wait(0.4);
    CHECK(player.game.magazine().fired() == 1);
}

TEST_CASE("With the mouse the fighter turns to where the pointer is", "[tunnel]") {
    struct Row {
        double x, y;
        Vec3 goes;  // the nose, from -z
    };
    for (const Row& row :
         {Row{1000, 250, {1, 0, 0}}, Row{0, 250, {-1, 0, 0}}, Row{500, 0, {0, 1, 0}}, Row{500, 500, {0, -1, 0}}}) {
        Player player = flying(three_cubes());
        player.game.take(event_of(WindowEventKind::resized, 1000, 500));
        player.game.take(event_of(WindowEventKind::pointer, row.x, row.y));
        player.wait(0.3);
        CHECK(player.world().angular_velocity[player.fighter()].isZero(1e-12));
        player.press('M');
        player.wait(0.4);
        CHECK((axes_of(player.world(), player.fighter()) * Vec3::UnitX()).dot(row.goes) > 0.1);
        player.press('M');
        player.wait(1);
        CHECK(player.world().angular_velocity[player.fighter()].norm() < 1e-3);
    }
}

TEST_CASE("The views follow each other, that of a missile only while one flies", "[tunnel]") {
    Player player = flying(with_crate());
    const auto next = [&] {
        player.press('V');
        player.wait(player.dt());
        return player.game.camera_man().view();
    };
    CHECK(player.game.camera_man().view() == View::behind);
    CHECK(next() == View::on_fighter);
    CHECK(next() == View::free);
    CHECK(next() == View::behind);
    CHECK(next() == View::on_fighter);
    player.down('F');
    player.wait(0.3);  // two missiles
    player.up('F');
    CHECK(next() == View::on_missile);
    const std::uint32_t second = player.game.tunnel().missiles[1];
    CHECK((player.game.camera(player.world()).eye - player.world().position[second]).norm() < 8);
    player.wait(0.45);  // both have exploded
    CHECK(missiles_in(player) == 0);
    CHECK(player.game.camera_man().view() == View::behind);
}

TEST_CASE("When the missile that is watched explodes, the view goes on to the one that still flies", "[tunnel]") {
    Player player = flying(with_crate());
    player.down('F');
    player.wait(0.1);
    player.up('F');
    player.press('V');
    player.wait(player.dt());
    player.press('V');
    player.wait(0.15);
    REQUIRE(player.game.camera_man().view() == View::on_missile);
    player.down('F');  // the next one leaves as soon as one may
    player.wait(0.22);
    player.up('F');
    CHECK(player.game.explosions() == 1);
    REQUIRE(missiles_in(player) >= 1);
    CHECK(player.game.camera_man().view() == View::on_missile);
    const std::uint32_t flying_one = *player.game.magazine().latest();
    CHECK((player.game.camera(player.world()).eye - player.world().position[flying_one]).norm() < 8);
}

TEST_CASE("The camera behind the fighter looks past it, or at it, from the distance that is asked for", "[tunnel]") {
    Player player = flying(three_cubes());
    player.wait(0.1);
    const auto distance = [&] { return (player.game.camera(player.world()).eye - player.position()).norm(); };
    const auto sight = [&] {
        const Camera camera = player.game.camera(player.world());
        return Vec3((camera.target - camera.eye).normalized());
    };
    const double usual = distance();
    CHECK(sight().dot(-Vec3::UnitZ()) > 0.99);
    CHECK(player.game.camera(player.world()).eye.z() > player.position().z() + 10);
    player.press(Key::tab);
    player.wait(0.1);
    const Vec3 to_fighter = (player.position() - player.game.camera(player.world()).eye).normalized();
    CHECK(sight().isApprox(to_fighter, 1e-9));
    player.down('C');
    player.wait(0.5);
    player.up('C');
    CHECK(distance() > 1.5 * usual);
    player.down('X');
    player.wait(5);
    CHECK(distance() < usual);
    CHECK(distance() > 5);
}

TEST_CASE("In the free view the keys move the camera and not the fighter", "[tunnel]") {
    Player player = flying(three_cubes());
    player.press('V');
    player.wait(player.dt());
    player.press('V');
    player.wait(player.dt());
    REQUIRE(player.game.camera_man().view() == View::free);
    const Vec3 eye = player.game.camera(player.world()).eye, fighter = player.position();
    player.down('W');
    player.wait(1);
    CHECK((player.game.camera(player.world()).eye - eye).norm() > 5);
    CHECK((player.position() - fighter).norm() < 1e-9);
}

TEST_CASE("What is put into the simulation changes only when the pilot or the motion changes it", "[tunnel]") {
    Player player = flying(three_cubes());
    player.press('1');
    player.wait(0.1);
    std::vector<Input> inputs;
    player.game.decide(player.world(), inputs);
    CHECK(inputs.empty());
    player.down('W');
    player.game.decide(player.world(), inputs);
    REQUIRE(inputs.size() == 1);
    CHECK(std::get<LoadInput>(inputs[0]).body == player.fighter());
}
