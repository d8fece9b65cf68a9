"""python -m unittest discover benches/peers: that the statistics of the comparison find what is known beforehand."""

import unittest

import numpy as np

from agreement import judge
from convergence import Level, brightness, ratio, reference, relative_errors, slope, time_to


def pictures(spp, seeds, generator, sigma=0.3, mean=0.5):
    return mean + sigma / np.sqrt(spp) * generator.standard_normal((seeds, 64, 64, 3))


def levels(seconds_per_sample, generator, sigma=0.3, noise=0.02):
    made = []
    for spp in (16, 32, 64):
        seconds = spp * seconds_per_sample * np.exp(noise * generator.standard_normal(5))
        made.append(Level(spp, seconds, relative_errors(pictures(spp, 5, generator, sigma), np.full((64, 64, 3), 0.5))))
    return made


class Statistics(unittest.TestCase):
    def setUp(self):
        self.generator = np.random.default_rng(7)

    def test_known_variance_is_found_without_a_reference(self):
        errors = relative_errors(pictures(4, 5, self.generator), np.full((64, 64, 3), 0.5))
        self.assertAlmostEqual(errors.mean() / (0.3**2 / 4 / 0.26), 1.0, delta=0.03)

    def test_noise_of_the_reference_is_taken_off(self):
        expected = 0.3**2 / 64 / 0.26
        noisy = reference(pictures(64, 5, self.generator))
        self.assertAlmostEqual(noisy.errors(pictures(64, 5, self.generator)).mean() / expected, 1.0, delta=0.04)
        self.assertAlmostEqual(noisy.noise / expected, 0.2, delta=0.01)

    def test_missing_light_is_an_error_though_nothing_scatters(self):
        known = reference(pictures(256, 5, self.generator))
        self.assertAlmostEqual(known.errors(np.zeros((3, 64, 64, 3))).mean(), 0.25 / 0.26, delta=0.01)

    def test_fireflies_do_not_hide_themselves_where_another_renderer_has_none(self):
        fireflies = np.full((3, 64, 64, 3), 0.5) + 20 * (self.generator.random((3, 64, 64, 1)) < 1e-2)
        clean = pictures(64, 3, self.generator, mean=0.7)
        expected = 20**2 * 1e-2 * (1 - 1e-2) / (0.7**2 + 0.01)
        self.assertAlmostEqual(relative_errors(fireflies, brightness([fireflies, clean])).mean() / expected, 1.0, delta=0.1)
        self.assertLess(relative_errors(fireflies, fireflies.mean(axis=0)).mean() / expected, 0.2)

    def test_slope_of_random_points(self):
        self.assertAlmostEqual(slope(levels(0.01, self.generator)), -1.0, delta=0.05)

    def test_ratio_to_itself_is_one_and_a_tenth_of_slowness_is_seen(self):
        ours, same, slower = (levels(cost, self.generator, noise=0.01) for cost in (0.01, 0.01, 0.011))
        self.assertAlmostEqual(ratio(ours, same).median, 1.0, delta=0.04)
        self.assertAlmostEqual(ratio(ours, slower).median, 1.1, delta=0.04)

    def test_noise_costs_its_square(self):
        ours, noisier = levels(0.01, self.generator), levels(0.01, self.generator, sigma=0.6)
        self.assertAlmostEqual(ratio(ours, noisier).median, 4.0, delta=0.3)

    def test_time_to_an_error_beyond_the_ladder(self):
        made = levels(0.01, self.generator)
        self.assertAlmostEqual(np.median(time_to(made, made[-1].errors.mean() / 4)) / (64 * 0.01 * 4), 1.0, delta=0.1)

    def test_agreement_and_its_negative_control(self):
        ours, theirs = pictures(256, 5, self.generator), pictures(256, 5, self.generator)
        self.assertEqual(judge(ours, theirs).verdict, "agree")
        self.assertEqual(judge(1.005 * ours, theirs).verdict, "differ")
        noisy = [pictures(0.01, 5, self.generator) for _ in range(2)]
        self.assertEqual(judge(*noisy).verdict, "no verdict")
        self.assertEqual(judge(1.001 * ours, theirs, offset=2e-3).verdict, "agree")


if __name__ == "__main__":
    unittest.main()
