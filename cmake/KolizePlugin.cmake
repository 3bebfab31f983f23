# kolize_add_plugin(STAGE NAME SOURCE... [LIBS LIBRARY...]): one plugin, one shared library.
#
# The library exports exactly one symbol, kolize_plugin (version script); it lands where `kolize` looks for plugins.
function(kolize_add_plugin stage name)
  cmake_parse_arguments(ARG "" "" "LIBS" ${ARGN})
  set(target kolize_${stage}_${name})
  add_library(${target} MODULE ${ARG_UNPARSED_ARGUMENTS})
  target_link_libraries(${target} PRIVATE kolize::framework ${ARG_LIBS})
  target_link_options(${target} PRIVATE
    -Wl,--version-script=${KOLIZE_PLUGIN_VERSION_SCRIPT} -Wl,--no-undefined-version)
  set_target_properties(${target} PROPERTIES
    PREFIX "" OUTPUT_NAME ${stage}_${name}
    CXX_VISIBILITY_PRESET hidden
    LIBRARY_OUTPUT_DIRECTORY ${KOLIZE_PLUGIN_DIRECTORY}
    LINK_DEPENDS ${KOLIZE_PLUGIN_VERSION_SCRIPT}
    DEFINE_SYMBOL ""  # no macro of its own, so that all plugins can share one precompiled header
    INSTALL_RPATH "$ORIGIN/..")
  get_property(others GLOBAL PROPERTY KOLIZE_PLUGINS)
  if(others)
    list(GET others 0 first)
    target_precompile_headers(${target} REUSE_FROM ${first})
  else()
    target_precompile_headers(${target} PRIVATE <kolize/plugin.h>)
  endif()
  install(TARGETS ${target} LIBRARY DESTINATION lib/kolize)
  set_property(GLOBAL APPEND PROPERTY KOLIZE_PLUGINS ${target})
endfunction()

set(KOLIZE_PLUGIN_VERSION_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/plugin.map)
