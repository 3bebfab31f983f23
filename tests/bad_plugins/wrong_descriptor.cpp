// The good fixture with one field of its descriptor replaced: WRONG_FIELD gets the value WRONG_VALUE (CMakeLists.txt).
#include "fixture.h"

namespace fixture {

using kolize::ParameterList;
using kolize::PluginDescriptor;
using kolize::Stage;
using kolize::StageKind;

Stage* create_throwing() { throw std::runtime_error("no grid today"); }
Stage* create_throwing_number() { throw 42; }
Stage* create_nothing() { return nullptr; }

void declare_throwing(ParameterList&) { throw std::runtime_error("no parameters today"); }
void declare_unnamed(ParameterList& list) { list.items.emplace_back(); }
void declare_twice(ParameterList& list) {
    list.items.resize(2);
    for (kolize::Parameter& parameter : list.items) parameter.name = "cell_size";
}
void declare_default_out_of_range(ParameterList& list) {
    kolize::Parameter& parameter = list.items.emplace_back();
    parameter.name = "passes";
    parameter.default_value = std::int64_t{9};
    parameter.min = 1;
    parameter.max = 8;
}

constexpr PluginDescriptor wrong_descriptor() {
    PluginDescriptor descriptor = kolize::describe<Fixture>(text);
    descriptor.WRONG_FIELD = WRONG_VALUE;
    return descriptor;
}

}  // namespace fixture

extern "C" KOLIZE_API const kolize::PluginDescriptor kolize_plugin;
constinit const kolize::PluginDescriptor kolize_plugin = fixture::wrong_descriptor();
