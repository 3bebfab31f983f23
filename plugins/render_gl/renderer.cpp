// Renderer: OpenGL 3.3 core on an image in memory, by libepoxy and EGL, which needs neither a display nor a graphics
// card; or in a window, by GLFW, with a panel by Dear ImGui.
//
// Bodies of one shape are drawn by one instanced call, so ten thousand cost a few calls only.
#include "billboards.h"
#include "bodies.h"
#include "context.h"
#include "lines.h"
#include "surfaces.h"
#include "target.h"
#include "text.h"
#include "window.h"

#include <kolize/plugin.h>

#include <memory>
#include <numbers>

namespace kolize::gl {
namespace {

constexpr float background[3] = {0.018f, 0.021f, 0.028f};

// All that lives in one context; the context goes last.
struct Studio {
    Studio(std::unique_ptr<Context> made, int width, int height, int samples)
        : context(std::move(made)), target(width, height, samples) {}

    std::unique_ptr<Context> context;
    Target target;
    Lighting lighting;
    Bodies bodies;
    Surfaces surfaces;
    Billboards billboards;
    Lines lines;
    Text text;
};

// The window that the studio's pictures are shown in. Pictures take its size.
class StudioWindow final : public Window {
public:
    StudioWindow(Studio& studio, GlfwWindow& window, int samples)
        : studio_(studio), window_(window), samples_(samples) {}

    int width() const override { return window_.width(); }
    int height() const override { return window_.height(); }
    void poll(std::vector<WindowEvent>& events) override {
        window_.poll(events);
        if (width() == studio_.target.width() && height() == studio_.target.height()) return;
        window_.make_current();
        studio_.target = Target(width(), height(), samples_);
    }
    void present(Panel* panel) override { window_.show(studio_.target, panel); }

private:
    Studio& studio_;
    GlfwWindow& window_;
    int samples_;
};

class GlRenderer final : public Renderer {
public:
    static void parameters(Parameters<GlRenderer>& p) {
        p.add("samples", &GlRenderer::samples_).range(1, 16).doc("Samples a pixel: 4 smooths edges, 1 is faster.");
        p.add("crease", &GlRenderer::crease_)
            .unit("deg")
            .range(0, 180)
            .doc("Meshes are rounded where triangles meet at less than this; 0 shows every triangle flat.");
        p.add("colour_by", &GlRenderer::colour_by_)
            .choices({"auto", "shape", "kind", "body"})
            .doc("What has a colour of its own; auto takes the first of shape, kind and body in which bodies differ.");
        p.add("gloss", &GlRenderer::gloss_).range(0, 1).doc("Strength of highlights on bodies.");
        p.add("pattern", &GlRenderer::pattern_)
            .choices({"checker", "grid", "plain"})
            .doc("Texture of walls and floors.");
        p.add("pattern_size", &GlRenderer::pattern_size_)
            .unit("m")
            .range(0, 1e9)
            .doc("Side of a square of the texture; 0 chooses it by the room or the bodies.");
        p.add("explosion_fps", &GlRenderer::explosion_fps_)
            .unit("1/s")
            .range(0.1, 1000)
            .doc("Pictures of an explosion a second of simulated time; it has 32.");
        p.add("explosion_scale", &GlRenderer::explosion_scale_)
            .range(0.01, 1000)
            .doc("Half the side of an explosion over the radius of the body that exploded.");
        p.add("explosion_pool", &GlRenderer::explosion_pool_)
            .range(0, 100000)
            .doc("At most so many explosions are shown at once, the newest.");
        p.add("billboard_turn", &GlRenderer::billboard_turn_)
            .choices({"spherical", "cylindrical"})
            .doc("Explosions turn freely, or about the camera's up direction only.");
        p.add("billboard_facing", &GlRenderer::billboard_facing_)
            .choices({"camera", "screen"})
            .doc("Explosions face the camera, or are parallel to the picture.");
    }

    ~GlRenderer() override { close(); }

    void open(int width, int height) override {
        close();
        studio_ = std::make_unique<Studio>(make_headless_context(), width, height, samples_);
    }

    Window& open_window(const std::string& title, int width, int height) override {
        close();
        auto window = std::make_unique<GlfwWindow>(title, width, height);
        GlfwWindow& opened = *window;
        studio_ = std::make_unique<Studio>(std::move(window), opened.width(), opened.height(), samples_);
        return window_.emplace(*studio_, opened, samples_);
    }

    void prepare(const World& world, const Scenery& scenery) override {
        studio_->context->make_current();
        studio_->bodies.prepare(world, scenery.skins, crease_ / 180 * std::numbers::pi, colour_by_);
        studio_->surfaces.prepare(world, scenery.rooms, pattern_size_);
    }

    void draw(const Frame& frame) override {
        studio_->context->make_current();
        studio_->target.clear(background);
        glEnable(GL_DEPTH_TEST);
        glEnable(GL_CULL_FACE);
        const View view(frame.camera, studio_->target.aspect());
        studio_->lighting.upload(frame, view);
        studio_->bodies.draw(frame.world, view, studio_->target.height(), static_cast<float>(gloss_));
        studio_->surfaces.draw(frame.world, view, pattern_, background);
        studio_->billboards.draw(frame, view, style());
        studio_->lines.draw(frame.lines, view, studio_->target.width(), studio_->target.height());
        studio_->text.draw(frame.captions, studio_->target.width(), studio_->target.height());
    }

    void read_pixels(Image& image) override {
        studio_->context->make_current();
        studio_->target.read(image);
    }

private:
    // What a context holds is destroyed while it is current.
    void close() {
        if (studio_) studio_->context->make_current();
        window_.reset();
        studio_.reset();
    }

    BillboardStyle style() const {
        return {billboard_turn_ == "cylindrical", billboard_facing_ == "screen", explosion_scale_, explosion_fps_,
                static_cast<std::size_t>(explosion_pool_)};
    }

    int samples_ = 4;
    double crease_ = 40;
    std::string colour_by_ = "auto";
    double gloss_ = 0.25;
    std::string pattern_ = "checker";
    double pattern_size_ = 0;
    double explosion_fps_ = 24;
    double explosion_scale_ = 4;
    int explosion_pool_ = 256;
    std::string billboard_turn_ = "spherical";
    std::string billboard_facing_ = "camera";
    std::unique_ptr<Studio> studio_;
    std::optional<StudioWindow> window_;
};

}  // namespace
}  // namespace kolize::gl

KOLIZE_PLUGIN(
    kolize::gl::GlRenderer, .name = "gl",
    .summary = "OpenGL 3.3 in a window, or on an image in memory without a display",
    .source =
        "Blinn-Phong shading: Blinn 1977; billboards: Akenine-Moeller, Haines and Hoffman, Real-Time Rendering (2018), "
        "13.6",
    .cost = "By Mesa's software rasteriser a few tens of milliseconds a picture of 1280x720; see docs/render.md.",
    .accuracy =
        "Bodies stand where the run has them, to the float precision of a graphics card; pictures of one driver are "
        "the same bytes again.",
    .choose = "Wherever a picture is wanted: it is the only renderer there is.")
