// Where the columns of fronts lie, and the memory that updates share.
#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

#include "check.hpp"
#include "umform/multifrontal/elimination.hpp"
#include "umform/multifrontal/panels.hpp"
#include "umform/multifrontal/plan.hpp"
#include "umform/multifrontal/schedule.hpp"
#include "umform/multifrontal/storage.hpp"

using namespace umform::multifrontal;

namespace {

/// Each entry on and below the diagonal has a place of its own, and the columns of a panel are as far apart as their stride.
void check_places(const Panels& panels, std::size_t rows, std::size_t columns, std::size_t left) {
    std::set<std::size_t> used;
    for (std::size_t j = 0; j < columns; ++j) {
        const std::size_t end = panels.end(j);
        CHECK(j < end && end <= columns);
        for (std::size_t i = panels.width() == 0 || j < left ? 0 : j; i < rows; ++i) {
            const std::size_t place = panels.column(j) + i;
            CHECK(place < panels.size() && used.insert(place).second);
        }
        if (j + 1 < end) CHECK(panels.column(j + 1) == panels.column(j) + panels.stride(j));
        CHECK(panels.begin(j) <= j && panels.end(panels.begin(j)) == end);
    }
    const std::size_t above = panels.size() - used.size();  // what is stored in vain
    CHECK(above <= (columns - left) * panels.width() / 2);
}

void check_panels() {
    for (const std::size_t columns : {1, 40, 48, 97, 400, 900})
        for (const std::size_t beyond : {0, 1, 130}) {
            const std::size_t rows = columns + beyond;
            check_places(Panels::of_factor(rows, columns, true), rows, columns, 0);
            check_places(Panels::of_factor(rows, columns, false), rows, columns, 0);
            CHECK(Panels::of_factor(rows, columns, false).size() == rows * columns);
            const std::size_t left = std::min(beyond, columns);
            check_places(Panels::of_update(rows, left, true), rows, rows, left);
            check_places(Panels::of_update(rows, left, false), rows, rows, left);
        }
}

/// Halves end where a panel begins, if one begins between: blocks of few columns lie in one panel.
void check_halves() {
    const Panels panels = Panels::of_factor(1000, 900, true);
    const int width = static_cast<int>(panels.width());
    for (int begin = 0; begin < 900; begin += 7)
        for (int count = 33; begin + count <= 900; count += 13) {
            const int left = panels.half(begin, count), next = (begin / width + 1) * width;
            CHECK(0 < left && left < count);
            if (next < begin + count) CHECK((begin + left) % width == 0);
        }
}

/// Memory from both ends, one piece where neighbours have come back; none twice, none before the floor.
void check_arena() {
    std::vector<double> memory(100);
    Arena arena;
    arena.reset(memory.data(), 100);
    double *a = arena.take(24, false, 0), *b = arena.take(16, true, 0), *c = arena.take(8, false, 0);
    CHECK(a == memory.data() && b == memory.data() + 84 && c == memory.data() + 24);
    CHECK(arena.take(60, false, 0) == nullptr);
    CHECK(arena.take(40, true, 50) == nullptr);  // 34 are left there
    double* d = arena.take(32, true, 50);
    CHECK(d == memory.data() + 52);
    arena.give(a, 24);
    CHECK(arena.take(32, false, 0) == nullptr);
    arena.give(c, 8);
    CHECK(arena.take(52, false, 0) == memory.data());
    arena.give(memory.data(), 52);
    arena.give(b, 16);
    arena.give(d, 32);
    CHECK(arena.take(100, true, 0) == memory.data());
    arena.reset(memory.data(), 100);
    CHECK(arena.take(8, false, 48) == memory.data() + 48);  // what is free on both sides stays so
    CHECK(arena.take(48, true, 0) == memory.data() && arena.take(44, true, 48) == memory.data() + 56);
    arena.reset(memory.data(), 0);
    CHECK(arena.take(8, false, 0) == nullptr);
}

/// Upper triangle of the pattern of a square grid of nodes with three equations each.
struct Grid {
    std::vector<std::int32_t> indptr{0}, indices;

    explicit Grid(int side) {
        for (int row = 0; row < 3 * side * side; ++row) {
            const int x = row / 3 % side, y = row / 3 / side;
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, side - 1); ++v)
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, side - 1); ++u)
                    for (int k = 0; k < 3; ++k)
                        if (const int column = 3 * (v * side + u) + k; column >= row) indices.push_back(column);
            indptr.push_back(static_cast<std::int32_t>(indices.size()));
        }
    }
};

/// Updates share the memory of the columns of the last front, apart from those of its children, which are still read while
/// these columns are filled: behind them there is room for all.
void check_last_front() {
    const Grid grid(40);
    const Rows rows{grid.indptr.data(), grid.indices.data(), static_cast<int>(grid.indptr.size()) - 1};
    const umform::ordering::Quotient quotient = umform::ordering::make_quotient(rows.indptr, rows.indices, rows.n);
    const Plan plan(rows, true, quotient, eliminate(quotient));
    const Schedule schedule(plan);
    const Front& last = plan.fronts.back();
    CHECK(schedule.last + 1 == static_cast<int>(plan.fronts.size()));
    const std::size_t columns = Panels::of_factor(last.size, last.pivots, true).size();
    CHECK(schedule.begin < last.factor + columns && last.factor + columns <= schedule.floor);

    std::vector<double> memory(schedule.end - schedule.begin);
    Arena arena;
    arena.reset(memory.data(), memory.size());
    const std::size_t floor = schedule.floor - schedule.begin;
    for (int k = plan.children_start[schedule.last]; k < plan.children_start[schedule.last + 1]; ++k) {
        const int child = plan.children[k];
        const std::size_t size = Arena::padded(Panels::of_update(plan.fronts[child].updates(), 0, true).size());
        const double* data = arena.take(size, schedule.side(child), floor);
        CHECK(data != nullptr && data >= memory.data() + floor);
    }
}

/// What finds no room in the arena comes from the pool, and goes back to where it has come from.
void check_rooms() {
    std::vector<double> memory(64);
    Arena arena;
    Pool pool;
    arena.reset(memory.data(), 64);
    Room first = Room::of(arena, pool, 33, false, 0), second = Room::of(arena, pool, 33, true, 0);
    CHECK(first.data == memory.data() && first.size == 40);
    CHECK(second.data != nullptr && second.own.size() == 33);
    second.release(arena, pool), first.release(arena, pool);
    CHECK(first.data == nullptr && pool.held() == 33);
    CHECK(Room::of(arena, pool, 64, true, 0).data == memory.data());
    CHECK(Room::of(arena, pool, 0, true, 0).data == nullptr);
}

/// Two stacks that meet in the middle.
void check_stacks() {
    std::vector<double> memory(10);
    Stacks stacks;
    stacks.use(memory.data(), 10);
    CHECK(stacks.push(2, 3) == memory.data() && stacks.push(4, 2) == memory.data() + 3);
    CHECK(stacks.push(3, 5) == memory.data() + 5);
    stacks.pop(4, 2), stacks.pop(3, 5);
    CHECK(stacks.push(1, 7) == memory.data() + 3);
}

}  // namespace

int main() {
    check_panels();
    check_halves();
    check_arena();
    check_last_front();
    check_rooms();
    check_stacks();
    return report("storage of fronts");
}
