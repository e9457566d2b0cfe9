// See series.hpp. A temporal collection of spatial collections with one grid of points for each body that has
// particles.
#include "series.hpp"

#include <charconv>

#include "atomic_file.hpp"
#include "hdf5_archive.hpp"

namespace ogive::io {
namespace {

std::string xml(std::string_view text) {
  std::string escaped;
  for (const char c : text) switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&apos;";
        break;
      case '\t':
      case '\n':
      case '\r':
        escaped += "&#" + std::to_string(static_cast<int>(c)) + ";";
        break;
      default:
        // XML 1.0 cannot hold the other control characters, not even by number.
        escaped += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  return escaped;
}

std::string shortest(double number) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, number);
  return {text, end.ptr};
}

std::string relative_to(const std::string& index, const std::string& file) {
  const auto slash = index.rfind('/');
  return file.starts_with('/') || slash == std::string::npos ? file : index.substr(0, slash + 1) + file;
}

std::string data_item(const std::string& file, const ArchiveReader::Array& array) {
  const char* kind = array.type == ElementType::float64 ? "Float" : array.type == ElementType::uint8 ? "UChar" : "Int";
  return std::string(R"(<DataItem Format="HDF" NumberType=")") + kind + R"(" Precision=")" +
         std::to_string(type_size(array.type)) + R"(" Dimensions=")" + shape_text(array.shape, " ") + "\">" +
         xml(file) + ":/" + xml(array.path) + "</DataItem>";
}

std::string field(const std::string& name, const std::string& file, const ArchiveReader::Array& array) {
  // Not "Tensor6": XDMF orders its components in another way than VTK does, and ParaView's readers disagree about who
  // is right. A matrix arrives as it is stored, and ParaView labels six columns as the file orders them.
  const std::uint64_t columns = array.shape.size() == 1 ? 1 : array.shape[1];
  const char* type = columns == 1 ? "Scalar" : columns == 3 ? "Vector" : columns == 9 ? "Tensor" : "Matrix";
  return R"(          <Attribute Name=")" + xml(name) + R"(" AttributeType=")" + type + R"(" Center="Node">)" +
         data_item(file, array) + "</Attribute>\n";
}

std::string body_grid(const ArchiveReader& reader, const std::string& file, const std::string& group) {
  const auto* name = reader.attribute<std::string>(group, "name");
  const auto* position = reader.find(group + "/position");
  // ParaView takes no empty grid: a body without particles is left out.
  if (!name || !position || position->count == 0) return "";
  const auto* connectivity = reader.find(group + "/connectivity");
  const auto is_field = [&](const ArchiveReader::Array& array) {
    return array.type == ElementType::float64 && array.path.starts_with(group + "/") && array.shape.size() <= 2 &&
           array.shape[0] == position->shape[0];
  };
  if (!is_field(*position) || position->shape.size() != 2 || position->shape[1] != 3)
    throw Failure(Fault::format, "array '" + position->path + "' does not hold points");
  if (!connectivity || connectivity->count != position->shape[0])
    throw Failure(Fault::format, "has no array '" + group + "/connectivity' of as many elements as points");
  const std::string count = std::to_string(position->shape[0]);
  std::string text = R"(        <Grid Name=")" + xml(*name) + "\" GridType=\"Uniform\">\n" +
                     R"(          <Topology TopologyType="Polyvertex" NumberOfElements=")" + count +
                     "\" NodesPerElement=\"1\">" + data_item(file, *connectivity) + "</Topology>\n" +
                     R"(          <Geometry GeometryType="XYZ">)" + data_item(file, *position) + "</Geometry>\n";
  for (const auto& array : reader.arrays())
    if (is_field(array) && &array != position) text += field(array.path.substr(group.size() + 1), file, array);
  return text + "        </Grid>\n";
}

std::string instant(const ArchiveReader& reader, const std::string& file) {
  const auto* time = reader.attribute<double>("", "time");
  if (reader.format() != kParticlesFormat.name || !time)
    throw Failure(Fault::format, "is not a particle file (its format is " + reader.format() + ")");
  std::string text =
      "      <Grid Name=\"bodies\" GridType=\"Collection\" CollectionType=\"Spatial\">\n        <Time Value=\"" +
      shortest(*time) + "\"/>\n";
  for (const auto& [group, attributes] : reader.attributes())
    if (!group.empty()) text += body_grid(reader, file, group);
  return text + "      </Grid>\n";
}

}  // namespace

void write_series(const std::string& path, const std::vector<std::string>& files) {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
      "    <Grid Name=\"particles\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (const auto& file : files) {
    try {
      text += instant(ArchiveReader(relative_to(path, file)), file);
    } catch (const Failure& failure) {
      throw Failure(failure.fault(), "particle file '" + file + "' " + failure.what());
    }
  }
  text += "    </Grid>\n  </Domain>\n</Xdmf>\n";
  AtomicFile output(path);
  output.write_at(0, text.data(), text.size());
  output.commit();
}

}  // namespace ogive::io
