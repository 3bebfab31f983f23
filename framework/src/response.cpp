#include <kolize/response.h>

#include <stdexcept>

namespace kolize {

void Response::save(std::vector<std::uint64_t>&) const {}

void Response::restore(std::span<const std::uint64_t> words) {
    if (!words.empty()) throw std::invalid_argument("this response remembers nothing, and was given something");
}

}  // namespace kolize
