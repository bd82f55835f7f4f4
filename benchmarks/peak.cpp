// What one core gives: multiply-adds in registers (GFlop/s of CPU time) and a + s b over arrays beyond the caches (GB/s).
#include <ctime>
#include <iostream>
#include <vector>

#include "umform/algebra/lanes.hpp"

using umform::Lanes;

namespace {

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double multiply_adds() {
    constexpr int chains = 12, rounds = 20'000'000;  // enough chains to hide the latency of all units
    Lanes sum[chains], factor = 1.0 - 1e-9, term = 1e-9;
    for (Lanes& chain : sum) chain = 0.5;
    const double start = seconds();
    for (int round = 0; round < rounds; ++round)
#pragma GCC unroll 12
        for (Lanes& chain : sum) chain = chain * factor + term;
    const double time = seconds() - start;
    Lanes total = 0.0;
    for (const Lanes& chain : sum) total += chain;
    if (total[0] < 0.0) std::cout << "never";
    return 2e-9 * chains * umform::lane_count * rounds / time;
}

double bandwidth() {
    constexpr std::size_t size = 16'000'000;
    std::vector<double> a(size, 1.0), b(size, 2.0);
    const double start = seconds();
    for (std::size_t i = 0; i < size; ++i) a[i] += 0.5 * b[i];
    const double time = seconds() - start;
    return 24e-9 * size / (a[size / 2] > 0.0 ? time : 0.0);
}

}  // namespace

int main() {
    double flops = 0.0, bytes = 0.0;
    for (int repeat = 0; repeat < 5; ++repeat) {
        flops = std::max(flops, multiply_adds());
        bytes = std::max(bytes, bandwidth());
    }
    std::cout << flops << ' ' << bytes << '\n';
}
