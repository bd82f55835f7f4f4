#include "umform/block.hpp"

template class umform::ShellBlockOf<18>;
