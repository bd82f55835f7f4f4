#include "umform/elements/block_output.hpp"

template class umform::ShellBlockOf<8>;
