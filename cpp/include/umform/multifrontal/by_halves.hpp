// The recursion of factors whose columns may fail: halves, so that most of the work is in products of large blocks.
#pragma once

#include <algorithm>

#include "umform/multifrontal/panel_solve.hpp"
#include "umform/multifrontal/panels.hpp"

namespace umform::multifrontal {

/// `Factors` eliminates a block (`try_block`), updates columns by others (`update`) and exchanges two columns (`exchange`);
/// `panels` says which columns may be a block.
template <class Factors>
class ByHalves {
  protected:
    /// Eliminates columns from `begin` on, of so many; those that fail are at the end. Returns the number of those that do not.
    int eliminate(int begin, int count) {
        if (count <= panel_width) return eliminate_few(begin, count);
        const int left = self().panels().half(begin, count), end = begin + count;
        const int first = eliminate(begin, left), failed = left - first;
        self().update(begin, first, begin + left, end);
        for (int k = 0; k < failed; ++k) self().exchange(begin + first + k, end - 1 - k);
        const int second = eliminate(begin + first, count - left);
        if (failed > 0) self().update(begin + first, second, end - failed, end);
        return first + second;
    }

  private:
    Factors& self() { return static_cast<Factors&>(*this); }

    int eliminate_few(int begin, int count) {
        int done = 0;
        for (int end = begin + count; begin + done < end;) {
            const int first = begin + done, next = std::min(end, static_cast<int>(self().panels().end(first)));
            const int now = self().try_block(first, next - first);
            self().update(first, now, next, begin + count);
            done += now;
            if (first + now < next) self().exchange(first + now, --end);
        }
        return done;
    }
};

}  // namespace umform::multifrontal
