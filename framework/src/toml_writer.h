// Writes TOML, line by line, with numbers that lose no bit.
#pragma once

#include <kolize/scene.h>

#include <charconv>

namespace kolize {

// C99's %a with as many digits as the bits need, in any locale.
inline std::string hex(double value) {
    char digits[32];
    const std::string text(digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::hex).ptr);
    return text[0] == '-' ? "-0x" + text.substr(1) : "0x" + text;
}

inline std::string hex(const Vec3& v) { return hex(v.x()) + " " + hex(v.y()) + " " + hex(v.z()); }
inline std::string hex(const Quat& q) { return hex(q.w()) + " " + hex(q.x()) + " " + hex(q.y()) + " " + hex(q.z()); }
inline std::string quoted(const std::string& text) { return to_string(Value(text)); }

// As decimals: the shortest that read back as the same numbers.
inline std::string list(const Vec3& v) {
    std::string text = "[";
    for (int i = 0; i < 3; ++i) text += (i ? ", " : "") + to_string(Value(v[i]));
    return text + "]";
}

class Writer {
public:
    void line(const std::string& text) { text_ += text + "\n"; }
    void table(const std::string& head) { line("\n" + head); }
    void plain(const std::string& key, const Value& value) { line(key + " = " + to_string(value)); }
    template <class T>
    void exact(const std::string& key, const T& value) {
        line(key + " = \"" + hex(value) + "\"");
    }
    void flag(const std::string& key, bool value) {
        if (value) plain(key, true);
    }
    void name(const std::string& key, const std::string& value) {
        if (!value.empty()) plain(key, value);
    }
    const std::string& text() const { return text_; }

private:
    std::string text_;
};

// [head] with the plugin and its settings.
void write_stage(Writer& out, const std::string& head, const StageConfig& stage);

// The tables of a pipeline, their names after the prefix: "", or "recording.pipeline.".
void write_pipeline(Writer& out, const PipelineConfig& pipeline, const std::string& prefix);

// [capsule] and [render].
void write_world(Writer& out, const Scene& scene, const std::string& reason);
void write_render(Writer& out, const RenderConfig& render, const World& world);

}  // namespace kolize
