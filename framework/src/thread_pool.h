// The one place that knows oneTBB.
#pragma once

#include <cstddef>
#include <memory>

namespace kolize {

class ThreadPool {
public:
    // The calling thread counts: there are threads - 1 workers.
    explicit ThreadPool(int threads);
    ~ThreadPool();

    // Calls task(context, i) for every i < count, as many at a time as there are threads. The task must not throw.
    using Task = void (*)(void* context, std::size_t i);
    void for_each(std::size_t count, Task task, void* context);

private:
    struct Arena;
    std::unique_ptr<Arena> arena_;
};

}  // namespace kolize
