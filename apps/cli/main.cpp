// The `burnish` program.
#include "apps/cli/program.h"

int main(int argc, char** argv)
{
    return burnish::run_program(argc, argv);
}
