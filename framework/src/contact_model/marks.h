#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace kolize {

// Set of small integers that is emptied in constant time.
class Marks {
public:
    void reserve(std::size_t size) { stamps_.reserve(size); }
    void reset(std::size_t size) {
        if (stamps_.size() < size) stamps_.resize(size, 0);
        if (++now_ == 0) {
            std::fill(stamps_.begin(), stamps_.end(), 0u);
            now_ = 1;
        }
    }
    void set(std::uint32_t i) { stamps_[i] = now_; }
    bool test(std::uint32_t i) const { return stamps_[i] == now_; }

private:
    std::vector<std::uint32_t> stamps_;
    std::uint32_t now_ = 0;
};

}  // namespace kolize
