#include <kolize/contact.h>

namespace kolize {

const char* to_string(StageKind stage) {
    switch (stage) {
    case StageKind::broadphase: return "broadphase";
    case StageKind::narrowphase: return "narrowphase";
    case StageKind::response: return "response";
    case StageKind::render: return "render";
    }
    return "unknown stage";
}

const char* to_string(Detail detail) {
    switch (detail) {
    case Detail::overlap: return "overlap";
    case Detail::normal: return "normal";
    case Detail::manifold: return "manifold";
    }
    return "unknown detail";
}

}  // namespace kolize
