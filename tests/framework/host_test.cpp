#include <catch2/catch.hpp>
#include <kolize/error.h>
#include <kolize/simulation.h>

#include "oracle/allocation_counter.h"

#include <atomic>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace kolize;

namespace {

// What parallel_for did: how often each item was visited, and each chunk's limits.
struct Visits {
    explicit Visits(std::size_t count, std::size_t grain)
        : items(count), chunks(Host::chunk_count(count, grain), {1, 0}) {}

    void run(Host& host, std::size_t grain) {
        host.parallel_for(items.size(), grain, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
            chunks[chunk] = {begin, end};
            for (std::size_t i = begin; i < end; ++i) ++items[i];
        });
    }

    std::vector<int> items;
    std::vector<std::pair<std::size_t, std::size_t>> chunks;
};

// Chunks 3, 5 and 6 of eight fail, the later ones first if they can.
void fail_in_three_chunks(Host& host) {
    host.parallel_for(8, 1, [](std::size_t chunk, std::size_t, std::size_t) {
        if (chunk == 3) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        if (chunk == 3 || chunk == 5 || chunk == 6) throw std::runtime_error("chunk " + std::to_string(chunk));
    });
}

}  // namespace

TEST_CASE("chunks cover every item once and are cut alike for any number of threads", "[host]") {
    const int threads = GENERATE(1, 2, 8);
    const std::size_t count = GENERATE(0, 1, 2, 63, 64, 65, 1000);
    const std::size_t grain = GENERATE(1, 7, 64, 5000);
    CAPTURE(threads, count, grain);
    const auto host = make_host(threads);
    Visits visits(count, grain);
    visits.run(*host, grain);
    CHECK(visits.items == std::vector<int>(count, 1));
    for (std::size_t i = 0; i < visits.chunks.size(); ++i) {
        CHECK(visits.chunks[i].first == i * grain);
        CHECK(visits.chunks[i].second == std::min(count, (i + 1) * grain));
    }
}

TEST_CASE("a grain beyond all items makes one chunk, a grain of nothing is refused", "[host]") {
    const auto host = make_host(GENERATE(1, 4));
    const std::size_t huge = std::numeric_limits<std::size_t>::max();
    Visits visits(5, huge);
    visits.run(*host, huge);
    CHECK(visits.items == std::vector<int>(5, 1));
    CHECK_THROWS_WITH(visits.run(*host, 0), "parallel_for: the grain must be at least 1, is 0");
}

TEST_CASE("the first exception by chunk order is rethrown, whatever the number of threads", "[host]") {
    const auto host = make_host(GENERATE(1, 2, 8));
    for (int i = 0; i < 20; ++i) CHECK_THROWS_WITH(fail_in_three_chunks(*host), "chunk 3");
    Visits afterwards(100, 3);
    afterwards.run(*host, 3);
    CHECK(afterwards.items == std::vector<int>(100, 1));
}

TEST_CASE("with one thread, or one chunk, everything runs where it was called", "[host]") {
    const auto caller = std::this_thread::get_id();
    const auto here = [&](std::size_t, std::size_t, std::size_t) { CHECK(std::this_thread::get_id() == caller); };
    make_host(1)->parallel_for(100, 1, here);
    make_host(8)->parallel_for(100, 100, here);
}

TEST_CASE("with one thread, or one chunk, a parallel loop allocates nothing", "[host]") {
    const auto host = make_host(GENERATE(1, 8));
    std::vector<int> items(1000);
    const std::size_t grain = host->threads() == 1 ? 10 : items.size();
    const AllocationCounter counter;
    host->parallel_for(items.size(), grain, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ++items[i];
    });
    CHECK(counter.count() == 0);
    CHECK(items == std::vector<int>(1000, 1));
}

TEST_CASE("as many chunks run at the same time as there are threads, and no more", "[host]") {
    const int threads = GENERATE(2, 3, 8);  // also more than there are cores
    CAPTURE(threads);
    const auto host = make_host(threads);
    CHECK(host->threads() == threads);
    std::atomic<int> inside{0}, most{0};
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    const auto everyone_came = [&] { return most >= threads || std::chrono::steady_clock::now() > deadline; };
    host->parallel_for(200, 1, [&](std::size_t, std::size_t, std::size_t) {
        const int now = ++inside;
        for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
        }
        while (!everyone_came()) std::this_thread::yield();
        --inside;
    });
    CHECK(most == threads);
}

TEST_CASE("a parallel loop may stand inside another one", "[host]") {
    const auto host = make_host(GENERATE(1, 4));
    std::vector<int> sums(16);
    host->parallel_for(16, 1, [&](std::size_t chunk, std::size_t, std::size_t) {
        std::vector<int> parts(10);
        host->parallel_for(10, 1, [&](std::size_t part, std::size_t, std::size_t) { parts[part] = 1; });
        for (const int part : parts) sums[chunk] += part;
    });
    CHECK(sums == std::vector<int>(16, 10));
}

TEST_CASE("a host with no thread is refused", "[host]") {
    CHECK_THROWS_AS(make_host(0), Error);
    CHECK_THROWS_WITH(make_host(-3), "the number of threads must be at least 1, is -3");
}
