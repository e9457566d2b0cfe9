// The program ogive: reads the command line, calls the command, turns what went wrong into one message and an exit
// code.
#include <ogive.h>

#include <boost/program_options.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <sstream>

#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

#include "check.hpp"
#include "failure.hpp"
#include "inspect.hpp"
#include "run.hpp"
#include "study.hpp"
#include "text.hpp"

namespace driver {
namespace {

namespace po = boost::program_options;

constexpr const char* kExitCodes =
    "Exit codes:\n"
    "   0  done\n"
    "   1  a defect of the program\n"
    "   2  the command line, the scene or a mesh is wrong; nothing was written\n"
    "   3  the computation broke down\n"
    "   4  a file cannot be read or written\n"
    "   5  a checkpoint or particle file is damaged, foreign or of an unknown version\n"
    "   6  memory could not be had; ogive restart goes on from the last checkpoint where there is one\n"
    "  75  interrupted by a signal after writing a checkpoint: ogive restart goes on\n";

/// One command: how it is called, what it takes and what it does.
struct Command {
  std::string name;
  std::string usage;    // what follows the name
  std::string summary;  // one line
  std::string details;
  std::string operand;  // name of its one positional argument
  po::options_description options;
  std::function<ExitCode(const std::string& operand, const po::variables_map& values)> call;
};

std::string help_of(const Command& command) {
  std::ostringstream text;
  text << "Usage: ogive " << command.name << ' ' << command.usage << "\n\n"
       << command.summary << "\n"
       << command.details << "\nOptions:\n"
       << command.options << '\n'
       << kExitCodes;
  return text.str();
}

template <typename Value>
std::optional<Value> optional_value(const po::variables_map& values, const char* name) {
  if (!values.count(name)) return std::nullopt;
  return values[name].as<Value>();
}

std::vector<std::string> settings_of(const po::variables_map& values) {
  return values.count("set") ? values["set"].as<std::vector<std::string>>() : std::vector<std::string>{};
}

/// A number that must be > 0, 0 included where `zero_allowed`.
double checked_number(const po::variables_map& values, const char* name) {
  const double value = values[name].as<double>();
  if (!std::isfinite(value) || !(value > 0)) {
    throw Failure(kExitInput, std::string("--") + name + ": must be > 0 and finite, got " + shortest(value));
  }
  return value;
}

Command run_command() {
  Command command;
  command.name = "run";
  command.usage = "SCENE.toml [options]";
  command.summary = "Runs a scene to its end and writes history, particles, checkpoints and a summary.";
  command.details =
      "The directory gets history.csv, summary.json, particles-*.h5 with particles.xdmf, and checkpoint-*.h5.\n"
      "On SIGINT, SIGTERM and SIGHUP the step is finished and a checkpoint written.\n";
  command.operand = "scene";
  command.options.add_options()                                                                               //
      ("output,o", po::value<std::string>(), "directory for the results (default: the scene's name + -out)")  //
      ("overwrite", "replace an earlier run's files in that directory")                                       //
      ("threads", po::value<int64_t>(),
       "threads, 0 for all processors (default: the scene's numerics.threads, or 1)")  //
      ("set", po::value<std::vector<std::string>>(),
       "path.to.key=value: overrides a value of the scene; @FILE: all values of a TOML file; may be repeated")                                   //
      ("until", po::value<double>(), "end time in the scene's unit of time (default: the scene's stop.time)")  //
      ("help", "this text");
  command.call = [](const std::string& operand, const po::variables_map& values) {
    RunOptions options;
    options.scene_file = operand;
    options.settings = settings_of(values);
    options.output = optional_value<std::string>(values, "output");
    options.overwrite = values.count("overwrite") > 0;
    options.threads = optional_value<int64_t>(values, "threads");
    options.until = optional_value<double>(values, "until");
    return run(options);
  };
  return command;
}

Command restart_command() {
  Command command;
  command.name = "restart";
  command.usage = "CHECKPOINT [options]";
  command.summary = "Goes on from a checkpoint, to the same bits as if the run had never stopped.";
  command.details =
      "CHECKPOINT is a file, or a directory whose newest undamaged checkpoint is taken. In the checkpoint's own "
      "directory\n"
      "the files of the run are continued; in another one new files begin. Scene and meshes are not needed any more.\n";
  command.operand = "checkpoint";
  command.options.add_options()                                                                        //
      ("output,o", po::value<std::string>(), "directory for the results (default: the checkpoint's)")  //
      ("overwrite", "replace an earlier run's files in another directory")                             //
      ("threads", po::value<int64_t>(), "threads, 0 for all processors (default: as in the run)")      //
      ("until", po::value<double>(), "end time in the scene's unit of time (default: as in the run)")  //
      ("set", po::value<std::vector<std::string>>(),
       "path.to.key=value: another value of output, stop or numerics.threads from here on; may be repeated")  //
      ("change-model", "lets --set change numerics, contact and materials as well, where that is consistent")  //
      ("help", "this text");
  command.call = [](const std::string& operand, const po::variables_map& values) {
    RestartOptions options;
    options.checkpoint = operand;
    options.settings = settings_of(values);
    options.change_model = values.count("change-model") > 0;
    options.output = optional_value<std::string>(values, "output");
    options.overwrite = values.count("overwrite") > 0;
    options.threads = optional_value<int64_t>(values, "threads");
    options.until = optional_value<double>(values, "until");
    return restart(options);
  };
  return command;
}

Command check_command() {
  Command command;
  command.name = "check";
  command.usage = "SCENE.toml [--set path.to.key=value]...";
  command.summary = "Checks a scene and tells what a run would do: the plan, bodies, particles, memory, steps, time.";
  command.details = "The time is measured by a few steps. Nothing is written.\n";
  command.operand = "scene";
  command.options.add_options()  //
      ("set", po::value<std::vector<std::string>>(),
       "path.to.key=value: overrides a value of the scene; @FILE: all values of a TOML file; may be repeated")  //
      ("help", "this text");
  command.call = [](const std::string& operand, const po::variables_map& values) {
    return check(operand, settings_of(values));
  };
  return command;
}

Command voxelise_command() {
  Command command;
  command.name = "voxelise";
  command.usage = "MESH --spacing S -o FILE [options]";
  command.summary = "Fills a closed surface mesh (STL, OFF) with particles and writes them as CSV: x,y,z,volume.";
  command.details = "The file can be a body of a scene: particles = \"FILE\".\n";
  command.operand = "mesh";
  command.options.add_options()                                                        //
      ("spacing", po::value<double>(), "distance of the particles, after scaling")     //
      ("scale", po::value<double>(), "factor for the mesh's coordinates (default 1)")  //
      ("output,o", po::value<std::string>(), "file to write")                          //
      ("help", "this text");
  command.call = [](const std::string& operand, const po::variables_map& values) {
    for (const char* needed : {"spacing", "output"}) {
      if (!values.count(needed))
        throw Failure(kExitInput, std::string("--") + needed + ": missing; see ogive voxelise --help");
    }
    MeshShape mesh;
    mesh.file = operand;
    mesh.spacing.fill(checked_number(values, "spacing"));
    if (values.count("scale")) mesh.scale = checked_number(values, "scale");
    return voxelise(mesh, values["output"].as<std::string>());
  };
  return command;
}

Command info_command() {
  Command command;
  command.name = "info";
  command.usage = "FILE [--verify]";
  command.summary = "Tells what a checkpoint or particle file holds.";
  command.details = "";
  command.operand = "file";
  command.options.add_options()                                                                   //
      ("verify", "read all of it and check every checksum; the exit code is 5 if it is damaged")  //
      ("help", "this text");
  command.call = [](const std::string& operand, const po::variables_map& values) {
    return info(operand, values.count("verify") > 0);
  };
  return command;
}

Command study_command() {
  Command command;
  command.name = "study";
  command.usage = "STUDY.toml [options]";
  command.summary = "Runs a scene with many settings, and tables and charts error, energy and cost.";
  command.details =
      "The directory gets study.json, study.csv, study.html (a page for the browser) and pictures. A case that was run\n"
      "before is not run again; after an interruption the same command goes on. Cases that break down are results too.\n";
  command.operand = "study";
  command.options.add_options()                                                                            //
      ("output,o", po::value<std::string>(), "directory for the results (default: the study's name + -study)")  //
      ("cache", po::value<std::string>(), "directory of the cases, which studies may share (default: cases in the output)")  //
      ("jobs,j", po::value<int64_t>()->default_value(1), "cases at once, a process each")                  //
      ("timeout", po::value<double>(), "seconds of processor time after which a case is given up (default: the study's timeout, or none)")  //
      ("only", po::value<std::vector<std::string>>(), "axis=label: these cases alone; may be repeated")  //
      ("no-pictures", "do not draw pictures")                                                            //
      ("list", "check the study and name its cases; nothing is run")                                       //
      ("help", "this text");
  command.call = [](const std::string& operand, const po::variables_map& values) {
    StudyOptions options;
    options.study_file = operand;
    options.output = optional_value<std::string>(values, "output");
    options.cache = optional_value<std::string>(values, "cache");
    const int64_t jobs = values["jobs"].as<int64_t>();
    if (jobs < 1 || jobs > 1024) throw Failure(kExitInput, "--jobs: must be 1 to 1024, got " + std::to_string(jobs));
    options.jobs = static_cast<int>(jobs);
    if (values.count("timeout")) options.timeout = checked_number(values, "timeout");
    if (values.count("only")) options.only = values["only"].as<std::vector<std::string>>();
    options.pictures = values.count("no-pictures") == 0;
    options.list = values.count("list") > 0;
    return study(options);
  };
  return command;
}

std::string general_help(const std::vector<Command>& commands) {
  std::string text = "Ogive " + std::string(ogive_version()) +
                     ": impact and penetration by the three-dimensional material point method.\n\n"
                     "Usage: ogive COMMAND ...\n\nCommands:\n";
  for (const Command& command : commands) {
    text += "  " + command.name + std::string(10 - command.name.size(), ' ') + command.usage + "\n            " +
            command.summary + '\n';
  }
  return text + "\nogive COMMAND --help tells more; ogive --version prints the version.\n\n" + kExitCodes;
}

ExitCode call_command(const Command& command, const std::vector<std::string>& arguments) {
  po::options_description all;
  all.add(command.options).add_options()(command.operand.c_str(), po::value<std::vector<std::string>>());
  po::positional_options_description positional;
  positional.add(command.operand.c_str(), -1);
  po::variables_map values;
  try {
    // No guessing: --out is not --output, so that new options never change what an old command line means.
    const int style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
    po::store(po::command_line_parser(arguments).options(all).positional(positional).style(style).run(), values);
  } catch (const po::error& error) {
    throw Failure(kExitInput, std::string(error.what()) + "; see ogive " + command.name + " --help");
  }
  if (values.count("help")) {
    std::cout << help_of(command);
    return kExitOk;
  }
  const auto operands = optional_value<std::vector<std::string>>(values, command.operand.c_str());
  if (!operands || operands->size() != 1) {
    throw Failure(kExitInput, "ogive " + command.name + ": expected one " + command.operand + ", got " +
                                  (operands ? std::to_string(operands->size()) : "none") + "; see ogive " +
                                  command.name + " --help");
  }
  return command.call(operands->front(), values);
}

ExitCode call_program(const std::vector<std::string>& arguments) {
  std::vector<Command> commands;
  for (const auto make : {run_command, restart_command, check_command, study_command, voxelise_command, info_command}) {
    commands.push_back(make());
  }
  if (arguments.empty()) throw Failure(kExitInput, "expected a command; see ogive --help");
  if (arguments[0] == "--help" || arguments[0] == "-h" || arguments[0] == "help") {
    std::cout << general_help(commands);
    return kExitOk;
  }
  if (arguments[0] == "--version") {
    std::cout << "ogive " << ogive_version() << '\n';
    return kExitOk;
  }
  std::vector<std::string> names;
  for (const Command& command : commands) {
    if (command.name == arguments[0]) return call_command(command, {arguments.begin() + 1, arguments.end()});
    names.push_back(command.name);
  }
  throw Failure(kExitInput, "unknown command \"" + arguments[0] + '"' + suggestion(arguments[0], names) +
                                " (commands: " + joined(names) + ")");
}

}  // namespace
}  // namespace driver

int main(int argument_count, char** arguments) {
#if defined(M_MMAP_THRESHOLD)
  // Large arrays go back to the system when they are given back; by default the limit grows with what has been freed.
  (void)mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
  try {
    return driver::call_program({arguments + 1, arguments + argument_count});
  } catch (const driver::Failure& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return failure.code();
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "ogive: memory could not be had\n");
    return driver::kExitMemory;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ogive: a defect of the program, please report it: %s\n", error.what());
    return driver::kExitInternal;
  }
}
