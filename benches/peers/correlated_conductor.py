"""A rough metal for Mitsuba with height-correlated shadowing and masking.

Mitsuba's own `roughconductor` takes G1(ωi)·G1(ωo), as if what shadows and what masks a microfacet were independent. This one takes
1 / (1/G1(ωi) + 1/G1(ωo) − 1) (Heitz 2014), which is 1/(1 + Λi + Λo). Distribution, Fresnel equations, sampling of visible normals and
whatever is around it are Mitsuba's.

Importing registers the plugin `correlatedconductor`; one of Mitsuba's variants must be set before.
"""

import drjit as dr
import mitsuba as mi


class CorrelatedConductor(mi.BSDF):
    def __init__(self, props):
        super().__init__(props)
        self.eta, self.k = mi.Color3f(props["eta"]), mi.Color3f(props["k"])
        if props["distribution"] != "ggx":
            raise ValueError("the distribution must be ggx")
        self.alpha = float(props["alpha"])
        self.m_components = [mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide]
        self.m_flags = self.m_components[0]

    def distribution(self):
        return mi.MicrofacetDistribution(mi.MicrofacetType.GGX, self.alpha, True)

    def fresnel(self, cosine):
        return mi.Color3f(*(mi.fresnel_conductor(cosine, dr.llvm.ad.Complex2f(self.eta[i], self.k[i])) for i in range(3)))

    def sample(self, ctx, si, sample1, sample2, active=True):
        distribution = self.distribution()
        m, _ = distribution.sample(si.wi, sample2)
        bs = dr.zeros(mi.BSDFSample3f)
        bs.wo = mi.reflect(si.wi, m)
        bs.eta, bs.sampled_component, bs.sampled_type = 1.0, mi.UInt32(0), mi.UInt32(+mi.BSDFFlags.GlossyReflection)
        value, bs.pdf = self.eval_pdf(ctx, si, bs.wo, active)
        good = active & (bs.pdf > 0)
        return bs, dr.select(good, value / bs.pdf, 0.0)

    def eval_pdf(self, ctx, si, wo, active=True):
        distribution = self.distribution()
        good = active & (mi.Frame3f.cos_theta(si.wi) > 0) & (mi.Frame3f.cos_theta(wo) > 0)
        m = dr.normalize(si.wi + wo)
        facets = distribution.eval(m) / (4 * mi.Frame3f.cos_theta(si.wi))
        masked, shadowed = distribution.smith_g1(si.wi, m), distribution.smith_g1(wo, m)
        both = dr.select((masked > 0) & (shadowed > 0), dr.rcp(dr.rcp(masked) + dr.rcp(shadowed) - 1), 0.0)
        value = self.fresnel(dr.dot(si.wi, m)) * (facets * both)
        return dr.select(good, value, 0.0), dr.select(good, facets * masked, 0.0)

    def eval(self, ctx, si, wo, active=True):
        return self.eval_pdf(ctx, si, wo, active)[0]

    def pdf(self, ctx, si, wo, active=True):
        return self.eval_pdf(ctx, si, wo, active)[1]

    def to_string(self):
        return f"CorrelatedConductor[alpha={self.alpha}]"


mi.register_bsdf("correlatedconductor", CorrelatedConductor)
