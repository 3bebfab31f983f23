#include "allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> allocations{0};

}  // namespace

AllocationCounter::AllocationCounter() : start_(allocations.load()) {}

std::size_t AllocationCounter::count() const { return allocations.load() - start_; }

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

bool AllocationCounter::available() { return false; }

#else

bool AllocationCounter::available() { return true; }

namespace {

void* counted(void* memory) {
    if (!memory) throw std::bad_alloc();
    ++allocations;
    return memory;
}

std::size_t rounded_up(std::size_t size, std::size_t alignment) {
    return (size + alignment - 1) / alignment * alignment;
}

}  // namespace

// The program's definitions replace those of the standard library everywhere; its other forms of new and delete
// ([], nothrow) call these.
void* operator new(std::size_t size) { return counted(std::malloc(size > 0 ? size : 1)); }

void* operator new(std::size_t size, std::align_val_t alignment) {
    const std::size_t a = static_cast<std::size_t>(alignment);
    return counted(std::aligned_alloc(a, rounded_up(size > 0 ? size : 1, a)));
}

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

#endif
