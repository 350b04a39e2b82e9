# Formula for Homebrew.
#
# UNTESTED: no brew has seen it, only `ruby -wc`, which finds its syntax right. Before use: put in homepage, where the
# release lies, and both checksums; then `brew audit --new --formula poesy` and `brew test poesy`.
class Poesy < Formula
  desc "Which errors of a parallel robot matter, and how much"
  homepage "https://poesy.example/"
  url "https://poesy.example/poesy-0.2.0.tar.gz"
  sha256 "0000000000000000000000000000000000000000000000000000000000000000"
  license all_of: ["Apache-2.0", "ISC"]

  depends_on "cli11" => :build
  depends_on "cmake" => :build
  depends_on "help2man" => :build
  depends_on "highway" => :build
  depends_on "ninja" => :build
  depends_on "nlohmann-json" => :build

  # Also those that programs need which are built with the installed libraries.
  depends_on "boost"
  depends_on "eigen"
  depends_on "fmt"
  depends_on "hdf5"
  depends_on :linux # built and tested with GCC on Linux alone
  depends_on "openssl@3"
  depends_on "tbb"
  depends_on "tomlplusplus"

  # Headers alone; Homebrew has no formula of them that we know of.
  resource "random123" do
    url "https://github.com/DEShawResearch/random123/archive/refs/tags/v1.14.0.tar.gz"
    sha256 "0000000000000000000000000000000000000000000000000000000000000000"
  end

  def install
    resource("random123").stage buildpath/"random123"
    args = %W[
      -DPOESY_TESTS=OFF
      -DPOESY_BENCH=OFF
      -DPOESY_MPI=OFF
      -DPOESY_UNITY=ON
      -DRANDOM123_INCLUDE_DIR=#{buildpath}/random123/include
    ]
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja", *args, *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    assert_match version.to_s, shell_output("#{bin}/poesy --version")
    (testpath/"study.toml").write shell_output("#{bin}/poesy template 3-prs")
    system bin/"poesy", "check", "study.toml"
    system bin/"poesy", "run", share/"poesy/mechanisms/3-rps/study.toml", "-o", "result.h5"
    system bin/"poesy", "verify", "result.h5"
  end
end
