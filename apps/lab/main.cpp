// The `burnish-lab` program: all of `burnish`, and its research: subcommands in commands.def, `bake ltc`,
// `chart --mip`, failure scenes.
#include "apps/cli/command.h"
#include "apps/cli/program.h"
#include "apps/lab/ltc/bake.h"
#include "apps/lab/mip/chart.h"
#include "core/lab/failure_scenes.h"

namespace burnish {
#define BN_LAB_COMMAND(name, summary) Command name##_command();
#include "apps/cli/commands.def"

namespace {

std::vector<Command> lab_commands()
{
    return {
#define BN_LAB_COMMAND(name, summary) name##_command(),
#include "apps/cli/commands.def"
    };
}

} // namespace
} // namespace burnish

int main(int argc, char** argv)
{
    burnish::add_parametric_scenes(burnish::failure_scenes());
    burnish::add_lab_commands(burnish::lab_commands);
    burnish::bake_ltc.set(burnish::run_ltc);
    burnish::chart_mips.set(burnish::run_mip_chart);
    return burnish::run_program(argc, argv);
}
