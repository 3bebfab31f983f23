#include "thread_pool.h"

#include <kolize/error.h>
#include <kolize/host.h>
#include <kolize/simulation.h>

#include <spdlog/logger.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <mutex>

namespace kolize {

namespace {

// The exception of the lowest chunk that failed.
class FirstFailure {
public:
    void record(std::size_t chunk, std::exception_ptr failure) {
        const std::lock_guard lock(mutex_);
        if (failure_ && chunk_ < chunk) return;
        chunk_ = chunk;
        failure_ = std::move(failure);
    }
    void rethrow() const {
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    std::mutex mutex_;
    std::size_t chunk_ = 0;
    std::exception_ptr failure_;
};

class ThreadHost final : public Host {
public:
    explicit ThreadHost(int threads)
        : threads_(threads), log_("kolize", std::make_shared<spdlog::sinks::stderr_color_sink_mt>()) {
        log_.set_pattern("%^%l%$: %v");
        if (threads > 1) pool_ = std::make_unique<ThreadPool>(threads);
    }

    int threads() const override { return threads_; }
    double now() const override {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    }
    void warn(std::string_view message) override { log_.warn("{}", message); }

protected:
    void run_chunks(std::size_t count, std::size_t grain, ChunkFunction function, void* context) override {
        if (grain == 0) throw std::invalid_argument("parallel_for: the grain must be at least 1, is 0");
        const auto run = [=](std::size_t chunk) {
            const std::size_t begin = chunk * grain;
            function(context, chunk, begin, begin + std::min(grain, count - begin));
        };
        const std::size_t chunks = chunk_count(count, grain);
        if (pool_ && chunks > 1)
            run_parallel(chunks, run);
        else
            for (std::size_t chunk = 0; chunk < chunks; ++chunk) run(chunk);
    }

private:
    // The pool orders memory by itself; `begun` and `done` say it again where the thread sanitizer can see it, which it
    // cannot inside oneTBB.
    template <class Run>
    void run_parallel(std::size_t chunks, const Run& run) {
        struct Job {
            const Run& run;
            FirstFailure failure;
            std::atomic<bool> begun{false};
            std::atomic<std::size_t> done{0};
        } job{run, {}, {}, {}};
        job.begun.store(true, std::memory_order_release);
        const auto task = [](void* context, std::size_t chunk) {
            Job& job = *static_cast<Job*>(context);
            job.begun.load(std::memory_order_acquire);
            try {
                job.run(chunk);
            } catch (...) {
                job.failure.record(chunk, std::current_exception());
            }
            job.done.fetch_add(1, std::memory_order_release);
        };
        pool_->for_each(chunks, task, &job);
        job.done.load(std::memory_order_acquire);
        job.failure.rethrow();
    }

    int threads_;
    spdlog::logger log_;
    std::unique_ptr<ThreadPool> pool_;  // none with one thread: chunks run inline, without oneTBB
};

}  // namespace

std::unique_ptr<Host> make_host(int threads) {
    if (threads < 1) throw Error("the number of threads must be at least 1, is " + std::to_string(threads));
    return std::make_unique<ThreadHost>(threads);
}

}  // namespace kolize
