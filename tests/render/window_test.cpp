// Windows of the renderer, on a display that nobody sees.
#include "render/studio.h"
#include "render/virtual_display.h"

#include <catch2/catch.hpp>

#include <atomic>
#include <chrono>
#include <thread>

using namespace kolize;
using namespace kolize::test;

namespace {

// A studio whose pictures are shown in a window.
struct Shop : Studio {
    explicit Shop(int width = 320, int height = 240) : Studio({}, width, height), window(open(width, height)) {}

    Window& open(int width, int height) {
        setenv("DISPLAY", virtual_display().name().c_str(), 1);
        return renderer->open_window("shop window", width, height);
    }
    bool hands(const std::string& what) const { return virtual_display().hands("search --name 'shop window' " + what); }
    // Draws and polls until this holds, a minute at most.
    template <class Done>
    bool until(Panel* panel, const Done& done) {
        const auto start = std::chrono::steady_clock::now();
        while (std::chrono::steady_clock::now() - start < std::chrono::seconds(60)) {
            window.poll(events);
            renderer->draw({world, 0, camera, lights, explosions});
            window.present(panel);
            ++pictures;
            if (done()) return true;
        }
        return false;
    }
    bool has(WindowEventKind kind, Key key) const {
        return std::any_of(events.begin(), events.end(),
                           [&](const WindowEvent& e) { return e.kind == kind && e.key == key; });
    }
    // The panel stands still in the meantime, as it would for a user.
    template <class Hands>
    bool while_hands(Panel* panel, const Hands& move) {
        bool moved = false, done = false;
        std::thread user([&] {
            moved = move();
            done = true;
        });
        const bool in_time = until(panel, [&] { return done; });
        user.join();
        return in_time && moved;
    }

    // For the thread of the hands: a click, with pictures in between, as a user sees them.
    void click(int x, int y) {
        const std::string place = std::to_string(x) + " " + std::to_string(y);
        for (const std::string& what :
             {"mousemove --window %1 " + place, std::string("mousedown 1"), std::string("mouseup 1")}) {
            hands(what);
            wait_for_pictures();
        }
    }
    void wait_for_pictures() const {
        for (const int wanted = pictures + 4; pictures < wanted;)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }

    Window& window;
    std::vector<WindowEvent> events;
    std::atomic<int> pictures = 0;
};

PanelItem choice() {
    PanelItem item{PanelItemKind::choice, "fruit", "fruit"};
    item.value = std::string("apple");
    item.options = {"apple", "pear", "plum"};
    return item;
}

}  // namespace

TEST_CASE("A window shows the same picture as one is drawn without a display", "[render][window]") {
    Shop shop;
    Studio studio;
    for (Studio* one : {static_cast<Studio*>(&shop), &studio}) {
        one->add(make_sphere("ball", 1), {-1.5, 0, 0});
        one->add(make_box("box", {1, 0.6, 0.4}), {1.5, 0.4, 0}, Quat(0.9, 0.3, 0.2, 0.1).normalized());
        one->rooms = {{Vec3(-4, -3, -3), Vec3(4, 3, 3)}};
        one->explosions = {{{0, 1, 1}, 0.3, 0}};
    }
    const Image in_window = shop.picture(0.4), without = studio.picture(0.4);
    CHECK(difference(in_window, without).count == 0);
    CHECK(difference(in_window, Studio().picture()).count > 10000);
}

TEST_CASE("Keys and clicks in a window arrive as events", "[render][window]") {
    Shop shop;
    shop.renderer->prepare(shop.world, {});
    REQUIRE(shop.while_hands(nullptr, [&] {
        return shop.hands("windowfocus %1 sleep 0.2 key --window %1 g Up F1 ctrl+Left") &&
               virtual_display().click("shop window", 100, 60);
    }));
    shop.until(nullptr, [&] { return shop.has(WindowEventKind::key_up, Key::left); });
    for (const Key key : {Key::g, Key::up, Key::f1, Key::left}) {
        CAPTURE(static_cast<int>(key));
        CHECK(shop.has(WindowEventKind::key_down, key));
        CHECK(shop.has(WindowEventKind::key_up, key));
    }
    const auto down = std::find_if(shop.events.begin(), shop.events.end(),
                                   [](const WindowEvent& e) { return e.kind == WindowEventKind::button_down; });
    REQUIRE(down != shop.events.end());
    CHECK(down->button == 0);
    CHECK(down->x == 100);
    CHECK(down->y == 60);
    const auto left = std::find_if(shop.events.begin(), shop.events.end(), [](const WindowEvent& e) {
        return e.kind == WindowEventKind::key_down && e.key == Key::left;
    });
    CHECK(left->control);
    CHECK_FALSE(shop.has(WindowEventKind::closed, Key::unknown));
}

TEST_CASE("A window that is resized says so, and its pictures have the new size", "[render][window]") {
    Shop shop;
    shop.renderer->prepare(shop.world, {});
    REQUIRE(shop.while_hands(nullptr, [&] { return shop.hands("windowsize --sync %1 400 300"); }));
    REQUIRE(shop.until(nullptr, [&] { return shop.window.width() == 400; }));
    const auto resized = std::find_if(shop.events.rbegin(), shop.events.rend(),
                                      [](const WindowEvent& e) { return e.kind == WindowEventKind::resized; });
    REQUIRE(resized != shop.events.rend());
    CHECK(resized->x == 400);
    CHECK(resized->y == 300);
    Image image;
    shop.renderer->read_pixels(image);
    CHECK(image.width == 400);
    CHECK(image.height == 300);
}

TEST_CASE("What is chosen, ticked and typed in the panel comes back, and is not reported as events",
          "[render][window][panel]") {
    Shop shop(600, 400);
    shop.renderer->prepare(shop.world, {});
    Panel panel{"settings", {}};
    PanelItem tick{PanelItemKind::toggle, "tick", "tick"}, size{PanelItemKind::number, "size", "size", "m"};
    tick.value = false;
    size.value = 2.0;
    size.min = 0, size.max = 10;
    panel.items = {choice(), tick, size};
    std::vector<std::string> edits;
    const auto note = [&] {
        for (const PanelItem& item : panel.items)
            if (item.edited) edits.push_back(item.id + " " + to_string(item.value));
        return false;
    };
    std::atomic<bool> done = false;
    std::thread user([&] {
        shop.wait_for_pictures();
        shop.click(80, 36);  // opens the list below the title bar
        shop.click(60, 90);  // one of its lines
        shop.click(15, 58);  // the box to tick
        shop.click(60, 82);  // the number
        for (const char* keys :
             {"windowfocus %1 key --window %1 ctrl+a", "type --window %1 --delay 100 25", "key --window %1 Return"}) {
            shop.hands(keys);
            shop.wait_for_pictures();
        }
        done = true;
    });
    const auto start = std::chrono::steady_clock::now();
    while (!done && std::chrono::steady_clock::now() - start < std::chrono::seconds(120))
        shop.until(&panel, [&] { return note(), true; });
    user.join();
    CAPTURE(edits);
    REQUIRE(edits.size() == 3);
    CHECK((edits[0] == "fruit \"pear\"" || edits[0] == "fruit \"plum\""));
    CHECK(edits[1] == "tick true");
    CHECK(edits[2] == "size 10.0");  // 25 is more than it may be
    CHECK(std::none_of(shop.events.begin(), shop.events.end(), [](const WindowEvent& e) {
        return e.kind == WindowEventKind::button_down || e.key == Key::digit_2;
    }));
}
