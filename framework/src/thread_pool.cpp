#include "thread_pool.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace kolize {

// oneTBB starts no more workers than there are cores unless it is allowed to; the arena bounds them from above.
struct ThreadPool::Arena {
    explicit Arena(int threads)
        : allowance(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)), arena(threads) {}

    tbb::global_control allowance;
    tbb::task_arena arena;
};

ThreadPool::ThreadPool(int threads) : arena_(std::make_unique<Arena>(threads)) {}

ThreadPool::~ThreadPool() = default;

// No coarser partition than one by one: the caller has cut the work to a worthwhile size.
void ThreadPool::for_each(std::size_t count, Task task, void* context) {
    arena_->arena.execute([=] {
        tbb::parallel_for(
            std::size_t{0}, count, [=](std::size_t i) { task(context, i); }, tbb::simple_partitioner{});
    });
}

}  // namespace kolize
