// Scenes: whatever the text, it is read or refused with a message for the user; the text that a checkpoint keeps of a scene
// reads back as itself. The part after a zero byte is a --set.
#include "document.hpp"
#include "failure.hpp"
#include "input.hpp"
#include "scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string all(reinterpret_cast<const char*>(data), size);
  const std::size_t cut = all.find('\0');
  try {
    driver::Document document = driver::Document::from_text(all.substr(0, cut), "scene.toml");
    if (cut != std::string::npos) {
      const std::string setting = all.substr(cut + 1);
      const std::size_t equals = setting.find('=');
      if (equals != std::string::npos)
        document.set(setting.substr(0, equals), setting.substr(equals + 1), "--set " + setting);
    }
    const driver::Scene scene = driver::read_scene(document, "scene.toml");
    const driver::Document again = driver::Document::from_text(scene.text, "kept.toml");
    const driver::Scene same = driver::read_scene(again, "scene.toml");
    fuzz::require(same.text == scene.text && same.bodies.size() == scene.bodies.size() && same.stop.time == scene.stop.time,
                  "the kept text is another scene");
    ++fuzz::accepted;
  } catch (const driver::Failure& failure) {
    fuzz::require(failure.what()[0] != '\0', "a refusal without a message");
  }
  return 0;
}
