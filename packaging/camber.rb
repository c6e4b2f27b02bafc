# Homebrew's formula of camber, for Linux. tests/lint/lint_tree.py holds version and libraries to CMake's.
class Camber < Formula
  desc "Line renderer for maps: kernels in parallel, exact pixels"
  homepage "https://camber.example.org/" # none yet, nor an address of the archive: docs/releasing.md
  url "https://camber.example.org/camber-0.1.0.tar.gz"
  sha256 "0000000000000000000000000000000000000000000000000000000000000000" # of the release's archive
  license "MIT"

  depends_on "cmake" => :build
  depends_on "llvm" => :build # clang compiles the kernels
  depends_on "ninja" => :build
  depends_on "pkgconf" => :build
  depends_on "cairo"
  depends_on "fontconfig"
  depends_on "fribidi"
  depends_on "gdal"
  depends_on "harfbuzz"
  depends_on "isa-l"
  depends_on "jansson"
  depends_on "libdeflate"
  depends_on "libmicrohttpd"
  depends_on "meshoptimizer"
  depends_on "libpng"
  depends_on :linux
  depends_on "lz4"
  depends_on "mesa-glu" # areas of mesh tiles
  depends_on "protobuf-c"
  depends_on "sqlite"
  depends_on "webp"
  depends_on "xz"
  depends_on "zlib"
  depends_on "zstd"

  resource "leaflet" do # in the tool, for the page of camber serve
    url "https://registry.npmjs.org/leaflet/-/leaflet-1.9.4.tgz"
    sha256 "84c65a256e50657896f54c33bd857b6849ebe94c817803be818bf32a3dde0b77"
  end

  def install
    (buildpath/"leaflet").install resource("leaflet")
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja", "-DCAMBER_TESTS=OFF", "-DCAMBER_WARM=OFF",
           "-DCAMBER_LIBDEFLATE=ON", "-DCAMBER_WEBP=ON", "-DCAMBER_SERVE=ON",
           "-DCAMBER_LZ4=ON", "-DCAMBER_ZSTD=ON", "-DCAMBER_LZMA=ON", "-DCAMBER_CAIRO=ON",
           "-DCAMBER_LEAFLET=#{buildpath}/leaflet/dist", *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  def post_install
    system bin/"camber", "info", "--warm"
  end

  test do
    (testpath/"line.geojson").write '{"type": "LineString", "coordinates": [[0, 0], [1, 1]]}'
    system bin/"camber", "render", "line.geojson", "-o", "line.png", "--size", "64x64"
    assert_path_exists testpath/"line.png"
  end
end
