#pragma once

#include <string_view>

/// Publications behind the methods of poesy, as BibTeX entries that a paper with a result can cite.
namespace poesy {

/// The source of the intervals of yields (stats/proportion.h).
inline constexpr std::string_view kClopperPearson = R"(@article{clopper1934,
  author = {Clopper, C. J. and Pearson, E. S.},
  title = {The use of confidence or fiducial limits illustrated in the case of the binomial},
  journal = {Biometrika},
  volume = {26}, number = {4}, pages = {404--413}, year = {1934},
  doi = {10.1093/biomet/26.4.404}
}
)";

/// The source of the intervals of the difference of two yields of the same machines (stats/proportion.h).
inline constexpr std::string_view kAgrestiMin = R"(@article{agresti2005,
  author = {Agresti, Alan and Min, Yongyi},
  title = {Simple improved confidence intervals for comparing matched proportions},
  journal = {Statistics in Medicine},
  volume = {24}, number = {5}, pages = {729--740}, year = {2005},
  doi = {10.1002/sim.1781}
}
)";

/// The source of the sensitivity indices at a pose and over the workspace (stats/indices.h).
inline constexpr std::string_view kDu = R"(@article{du2022,
  author = {Du, Xu and Wang, Bin and Zheng, Junqiang},
  title = {Geometric Error Analysis of a 2{UPR}-{RPU} Over-Constrained Parallel Manipulator},
  journal = {Machines},
  volume = {10}, number = {11}, pages = {990}, year = {2022},
  doi = {10.3390/machines10110990}
}
)";

/// The source of intervals of sums of two estimates, used for indices over the workspace (stats/indices.h).
inline constexpr std::string_view kZouDonner = R"(@article{zou2008,
  author = {Zou, Guang Yong and Donner, Allan},
  title = {Construction of confidence limits about effect measures: A general approach},
  journal = {Statistics in Medicine},
  volume = {27}, number = {10}, pages = {1693--1702}, year = {2008},
  doi = {10.1002/sim.3095}
}
)";

/// The source of first-order and total indices from squared differences (stats/squared_differences.h).
inline constexpr std::string_view kJansen = R"(@article{jansen1999,
  author = {Jansen, Michiel J. W.},
  title = {Analysis of variance designs for model output},
  journal = {Computer Physics Communications},
  volume = {117}, pages = {35--43}, year = {1999},
  doi = {10.1016/S0010-4655(98)00154-4}
}
)";

}  // namespace poesy
