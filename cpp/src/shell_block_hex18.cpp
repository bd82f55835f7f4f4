#include "umform/elements/block.hpp"

template class umform::ShellBlockOf<18>;
