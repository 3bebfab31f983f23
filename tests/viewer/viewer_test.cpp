// What keys, pointer and panel do to a running scene, without a window.
#include "framework/capsules.h"
#include "viewer/pipeline_panel.h"
#include "viewer/viewer.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::cli;
using namespace kolize::test;

namespace {

struct Desk {
    explicit Desk(Scene scene = mixed_crowd())
        : host(make_host(1)),
          session({std::move(scene), {}}, liars(), *host, 1000),
          viewer(
              session, liars(), 1.5, [this](const std::string& line) { said.push_back(line); }, false, Overlays()) {}

    void press(Key key) {
        down(key);
        viewer.handle({WindowEventKind::key_up, key}, 600);
    }
    void down(Key key) { viewer.handle({WindowEventKind::key_down, key}, 600); }
    void pointer(WindowEventKind kind, double x, double y, std::uint32_t button = 0) {
        WindowEvent event{kind};
        event.button = button;
        event.x = x, event.y = y;
        viewer.handle(event, 600);
    }
    void steps(int count) {
        for (int i = 0; i < count; ++i) viewer.step();
    }
    const PanelItem& item(const std::string& id) {
        for (PanelItem& item : viewer.panel()->items)
            if (item.id == id) return item;
        FAIL("the panel has no item " << id);
        throw 0;
    }
    void edit(const std::string& id, const Value& value) {
        for (PanelItem& item : viewer.panel()->items)
            if (item.id == id) item.value = value, item.edited = true;
        viewer.take_edits();
    }
    const Forces& forces() const { return session.simulation().world().forces; }

    std::vector<std::string> said;
    std::unique_ptr<Host> host;
    Session session;
    Viewer viewer;
};

bool shows(const Shot& shot, const std::string& text) {
    return std::any_of(shot.captions.begin(), shot.captions.end(),
                       [&](const Caption& c) { return c.text.find(text) != std::string::npos; });
}

}  // namespace

TEST_CASE("The keys of the viewer", "[viewer]") {
    Desk desk;
    SECTION("T and R change the drag, which never goes below 0") {
        const double before = desk.forces().drag;
        desk.press(Key::t);
        CHECK(desk.forces().drag == Approx(before + 0.05));
        for (int i = 0; i < 5; ++i) desk.press(Key::r);
        CHECK(desk.forces().drag == 0);
    }
    SECTION("G with the arrows switches gravity; the arrows alone do nothing") {
        const Vec3 gravity = desk.forces().gravity;
        desk.press(Key::up);
        CHECK(desk.forces().gravity == gravity);
        desk.down(Key::g);
        desk.press(Key::up);
        CHECK(desk.forces().gravity == Vec3::Zero());
        desk.press(Key::down);
        CHECK(desk.forces().gravity == gravity);
        desk.viewer.handle({WindowEventKind::key_up, Key::g}, 600);
        desk.press(Key::up);
        CHECK(desk.forces().gravity == gravity);
    }
    SECTION("P pauses and N takes one step") {
        desk.press(Key::p);
        CHECK_FALSE(desk.viewer.is_running());
        CHECK(shows(desk.viewer.shot(), "paused"));
        CHECK_FALSE(desk.viewer.takes_single_step());
        desk.press(Key::n);
        CHECK(desk.viewer.takes_single_step());
        CHECK_FALSE(desk.viewer.takes_single_step());
        desk.press(Key::space);
        CHECK(desk.viewer.is_running());
    }
    SECTION("minus and = halve and double the speed") {
        desk.press(Key::minus);
        desk.press(Key::minus);
        CHECK(desk.viewer.speed() == 0.25);
        desk.press(Key::equal);
        CHECK(desk.viewer.speed() == 0.5);
    }
    SECTION("H shows the keys, Tab the panel, F12 asks for a picture, Esc ends") {
        CHECK_FALSE(shows(desk.viewer.shot(), "this help"));
        desk.press(Key::h);
        CHECK(shows(desk.viewer.shot(), "this help"));
        CHECK(desk.viewer.panel() != nullptr);
        desk.press(Key::tab);
        CHECK(desk.viewer.panel() == nullptr);
        desk.press(Key::f12);
        CHECK(desk.viewer.takes_screenshot());
        CHECK_FALSE(desk.viewer.is_closed());
        desk.press(Key::escape);
        CHECK(desk.viewer.is_closed());
    }
}

TEST_CASE("Home goes back to the start: from there the run is the same again, and a recording has it", "[viewer]") {
    Desk desk;
    desk.session.record();
    desk.steps(1);
    const std::uint64_t after_one = desk.session.simulation().state_hash();
    desk.press(Key::t);
    desk.steps(60);  // a missile is gone by then
    CHECK(desk.session.simulation().world().removed != desk.session.scene().world.removed);
    desk.press(Key::home);
    desk.steps(1);
    CHECK(desk.session.simulation().state_hash() == after_one);
    desk.steps(20);

    const ScratchFolder folder;
    desk.session.write_recording(folder.path() / "run.rec");
    const SceneOptions options{{}, {}, {"grid", "moller", "impulse"}};
    Session again(load_subject("", {"", (folder.path() / "run.rec").string()}, options, liars()), liars(), *desk.host,
                  100);
    for (int i = 0; i < 82; ++i) again.step();
    CHECK(again.compared() == 82);
    CHECK_FALSE(again.parting());
    CHECK(again.simulation().state_hash() == desk.session.simulation().state_hash());
}

TEST_CASE("The pointer turns, shifts and approaches without leaving the target", "[viewer]") {
    Desk desk;
    const Camera start = desk.viewer.shot().camera;
    const double distance = (start.eye - start.target).norm();
    desk.pointer(WindowEventKind::button_down, 300, 300);
    desk.pointer(WindowEventKind::pointer, 400, 250);
    desk.pointer(WindowEventKind::button_up, 400, 250);
    const Camera turned = desk.viewer.shot().camera;
    CHECK((turned.eye - turned.target).norm() == Approx(distance));
    CHECK(turned.target == start.target);
    const double angle = std::acos((turned.eye - turned.target).dot(start.eye - start.target) / (distance * distance));
    CHECK(angle > 0.3);
    desk.pointer(WindowEventKind::pointer, 500, 300);  // no button is held
    CHECK(desk.viewer.shot().camera.eye == turned.eye);

    desk.pointer(WindowEventKind::scroll, 0, 1);
    const Camera near = desk.viewer.shot().camera;
    CHECK((near.eye - near.target).norm() == Approx(0.9 * distance));

    desk.pointer(WindowEventKind::button_down, 300, 300, 1);
    desk.pointer(WindowEventKind::pointer, 300, 360, 1);
    const Camera shifted = desk.viewer.shot().camera;
    CHECK((shifted.eye - near.eye - (shifted.target - near.target)).norm() < 1e-12);
    const double tenth_of_height = 0.1 * 2 * std::tan(0.5 * near.field_of_view) * 0.9 * distance;
    CHECK((shifted.target - near.target).norm() == Approx(tenth_of_height));

    desk.press(Key::c);
    CHECK(desk.viewer.shot().camera.eye == start.eye);
    // Up and over: the eye stays short of the pole.
    desk.pointer(WindowEventKind::button_down, 300, 0);
    desk.pointer(WindowEventKind::pointer, 300, 4000);
    const Camera top = desk.viewer.shot().camera;
    CHECK((top.eye - top.target).cross(top.up).norm() > 0.05 * distance);
}

TEST_CASE("The panel lists for each stage the plugins and parameters with unit and range", "[viewer][panel]") {
    Desk desk;
    const PanelItem plugin = desk.item("broadphase.plugin");
    CHECK(std::get<std::string>(plugin.value) == "grid");
    CHECK(plugin.options == liars().names(StageKind::broadphase));
    const PanelItem cell = desk.item("broadphase.cell_size");
    const LoadedPlugin& grid = liars().require(StageKind::broadphase, "grid");
    const Parameter& declared = *grid.parameters.find("cell_size");
    CHECK(std::get<double>(cell.value) == 1.7);
    CHECK(cell.unit == declared.unit);
    CHECK(cell.min == declared.min);
    CHECK(cell.max == declared.max);
    CHECK(cell.help == declared.doc);
    CHECK(std::get<std::string>(desk.item("response.1.plugin").value) == "explode");
    CHECK(std::get<std::int64_t>(desk.item("response.2.max_impulses").value) == 50);
    CHECK(desk.item("step.mode").options == stepping_names());
    for (const PanelItem& item : desk.viewer.panel()->items)
        CHECK(std::count_if(desk.viewer.panel()->items.begin(), desk.viewer.panel()->items.end(),
                            [&](const PanelItem& other) { return other.id == item.id; }) == 1);
}

TEST_CASE("A plugin chosen in the panel takes over at the next step, and the step stays marked", "[viewer][panel]") {
    Desk desk, untouched;
    desk.steps(10);
    desk.edit("broadphase.plugin", std::string("bsp"));
    CHECK(desk.said.back() == "step 10: broadphase.plugin = bsp");
    CHECK(desk.session.simulation().broadphase().plugin == "bsp");
    desk.steps(20);
    untouched.steps(30);
    CHECK(desk.session.simulation().state_hash() == untouched.session.simulation().state_hash());

    const PanelItem graph = desk.item("times.graph");
    REQUIRE(graph.marks.size() == 1);
    CHECK(graph.marks[0].before == 10);
    CHECK(graph.series[0].values.size() == 30);
    CHECK(std::get<std::string>(desk.item("times.mark").value) == "step 10: broadphase.plugin = bsp");
    desk.steps(static_cast<int>(History::length) - 25);
    CHECK(desk.item("times.graph").marks[0].before == 5);
    desk.steps(10);
    CHECK(desk.item("times.graph").marks.empty());
}

TEST_CASE("What does not fit is refused in the panel, and the pipeline stays", "[viewer][panel]") {
    Desk desk;
    desk.steps(3);
    desk.edit("narrowphase.contact", std::string("contour"));
    CHECK(desk.said.back() == "step 3: narrowphase.contact = contour");
    desk.edit("broadphase.cell_size", -4.0);
    CHECK(desk.said.back().starts_with("step 3: refused: "));
    CHECK(std::get<std::string>(desk.item("message").value).find("cell_size") != std::string::npos);
    CHECK(std::get<double>(desk.item("broadphase.cell_size").value) == 1.7);
    desk.edit("response.2.max_impulses", std::int64_t(70));
    CHECK(std::get<std::int64_t>(desk.item("response.2.max_impulses").value) == 70);
    for (const PanelItem& item : desk.viewer.panel()->items) CHECK(item.id != "message");
}

TEST_CASE("Overlays are ticked in the panel, those that the pipeline can show", "[viewer][panel]") {
    Desk desk;
    desk.steps(20);
    const auto offered = [&](const std::string& id) {
        const auto& items = desk.viewer.panel()->items;
        return std::any_of(items.begin(), items.end(), [&](const PanelItem& item) { return item.id == id; });
    };
    CHECK(offered("overlay.cells"));
    CHECK_FALSE(offered("overlay.planes"));
    CHECK(desk.viewer.shot().lines.empty());
    desk.edit("overlay.bounds", true);
    CHECK_FALSE(desk.viewer.shot().lines.empty());
    desk.edit("overlay.bounds", false);
    CHECK(desk.viewer.shot().lines.empty());
    desk.edit("broadphase.plugin", std::string("bsp"));
    CHECK(offered("overlay.planes"));
}

TEST_CASE("The graphs count what the simulation counts", "[viewer][panel]") {
    Desk desk;
    std::vector<float> pairs, contacts;
    for (int i = 0; i < 40; ++i) {
        desk.steps(1);
        pairs.push_back(static_cast<float>(desk.session.simulation().pairs().size()));
        contacts.push_back(static_cast<float>(desk.session.simulation().contacts().rows.size()));
    }
    CHECK(desk.item("counts.graph").series[0].values == pairs);
    CHECK(desk.item("counts.graph").series[1].values == contacts);
    CHECK(*std::max_element(contacts.begin(), contacts.end()) > 0);
    for (const PanelSeries& times : desk.item("times.graph").series)
        CHECK(std::all_of(times.values.begin(), times.values.end(), [](float us) { return us >= 0; }));
}
