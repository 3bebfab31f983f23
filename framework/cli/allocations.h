// Counts the heap allocations of the whole program, libraries and plugins included.
#pragma once

#include <cstddef>

class AllocationCounter {
public:
    AllocationCounter();

    // Calls of operator new by any thread since construction.
    std::size_t count() const;

    // False under a sanitizer, which brings its own operator new: count() then stays 0.
    static bool available();

private:
    std::size_t start_;
};
