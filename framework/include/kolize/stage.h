// The kinds of stage, and what every stage object has in common.
#pragma once

#include <kolize/host.h>

#include <cstdint>
#include <string>

namespace kolize {

enum class StageKind : std::uint32_t { broadphase, narrowphase, response, render };

// "broadphase", "narrowphase", "response", "render".
KOLIZE_API const char* to_string(StageKind);

// Base of every object that a plugin makes. Parameters are set after construction and before attach();
// attach() may throw std::invalid_argument when they do not go together.
class KOLIZE_API Stage {
public:
    virtual ~Stage() = default;
    virtual void attach(Host& host) { host_ = &host; }
    // What it chose or found out while running, and why, in one sentence for the user; "" if there is nothing to say.
    virtual std::string report() const { return {}; }

protected:
    Host& host() const { return *host_; }

private:
    Host* host_ = nullptr;
};

}  // namespace kolize
