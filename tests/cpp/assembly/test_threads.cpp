// Loops over a team: every range once, and the first exception.
#include <stdexcept>
#include <vector>

#include "check.hpp"
#include "umform/assembly/threads.hpp"

using namespace umform;

namespace {

void check_ranges() {
    for (const int count : {0, 1, 63, 64, 65, 1000})
        for (const int threads : {1, 3}) {
            std::vector<int> visits(count);
            for_each_range(count, threads, [&](int first, int last) {
                for (int k = first; k < last; ++k) ++visits[k];
            });
            CHECK(visits == std::vector<int>(count, 1));
        }
}

void check_exceptions() {
    const auto failing = [](int first, int last) {
        if (first <= 500 && 500 < last) throw std::runtime_error("500");
    };
    CHECK(throws<std::runtime_error>([&] { for_each_range(1000, 3, failing); }));
}

}  // namespace

int main() {
    check_ranges();
    check_exceptions();
    return report("threads");
}
