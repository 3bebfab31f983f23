// Pipeline files: the stages of a pipeline with all that sets them, which `--pipeline FILE` puts in place of a scene's.
#pragma once

#include <kolize/scene.h>

namespace kolize {

// The text of a file from which load_scene reads the same pipeline.
KOLIZE_API std::string pipeline_text(const PipelineConfig& pipeline);

}  // namespace kolize
