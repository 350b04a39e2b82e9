"""Tests what kernels_for_gpu.py reports about LLVM code."""

import unittest

from kernels_for_gpu import problems


class Problems(unittest.TestCase):
    def test_a_device_has_square_roots_and_memory(self):
        self.assertEqual(list(problems("declare double @sqrt(double) #1\ndeclare noalias ptr @_Znwm(i64)\n"
                                       "declare void @llvm.memcpy.p0.p0.i64(ptr, ptr, i64, i1)\n")), [])

    def test_it_has_no_output(self):
        self.assertEqual(list(problems("declare i32 @printf(i8*, ...)\n")), ["calls printf, which a GPU does not have"])

    def test_it_has_constants(self):
        self.assertEqual(list(problems("@series = linkonce_odr dso_local constant [8 x double] zeroinitializer\n")), [])

    def test_it_has_no_global_variables(self):
        self.assertEqual(list(problems("@_ZL5calls = internal global i32 0, align 4\n")),
                         ["has the global variable _ZL5calls"])


if __name__ == "__main__":
    unittest.main()
