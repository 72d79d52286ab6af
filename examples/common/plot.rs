//! Curves over a logarithmic scale, as SVG.

use std::path::Path;

use plotters::element::DashedPathElement;
use plotters::prelude::*;

/// Pixels.
const SIZE: (u32, u32) = (900, 560);

/// Some of Okabe and Ito's colours, which nobody mistakes for each other.
const COLOURS: [RGBColor; 4] =
    [RGBColor(0, 0, 0), RGBColor(230, 159, 0), RGBColor(0, 114, 178), RGBColor(213, 94, 0)];

/// A named list of points.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    pub(crate) name: String,
    pub(crate) dashed: bool,
    /// Index of a colour, 0 to 3.
    pub(crate) colour: usize,
    pub(crate) points: Vec<(f64, f64)>,
}

/// Curves, and what their axes mean.
#[derive(Clone, Debug)]
pub(crate) struct Plot {
    pub(crate) title: String,
    pub(crate) across: String,
    pub(crate) up: String,
    /// Least value shown.
    pub(crate) least: f64,
    pub(crate) curves: Vec<Curve>,
}

impl Plot {
    /// Writes the plot, and makes its directory.
    pub(crate) fn save(&self, path: &Path) -> Result<(), Box<dyn std::error::Error>> {
        if let Some(directory) = path.parent() {
            std::fs::create_dir_all(directory)?;
        }
        let area = SVGBackend::new(path, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let right = points().map(|point| point.0).fold(0.0, f64::max);
        let top = points().map(|point| point.1).fold(self.least, f64::max);
        let mut chart = ChartBuilder::on(&area)
            .caption(&self.title, ("sans-serif", 20))
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(64)
            .build_cartesian_2d(0.0..right, (self.least..top * 1.5).log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .x_desc(&self.across)
            .y_desc(&self.up)
            .x_label_formatter(&|x| format!("{x:.0}"))
            .y_label_formatter(&|y| format!("{y:.0e}"))
            .label_style(("sans-serif", 14))
            .draw()?;
        for curve in &self.curves {
            let shown = curve.points.iter().copied().take_while(|point| point.1 >= self.least);
            let style = COLOURS[curve.colour].stroke_width(2);
            let legend = |(x, y)| [(x, y), (x + 30, y)];
            if curve.dashed {
                let series = DashedLineSeries::new(shown, 6, 4, style);
                let label = chart.draw_series(series)?.label(&curve.name);
                label.legend(move |at| DashedPathElement::new(legend(at), 6, 4, style));
            } else {
                let label = chart.draw_series(LineSeries::new(shown, style))?.label(&curve.name);
                label.legend(move |at| PathElement::new(legend(at), style));
            }
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .legend_area_size(36)
            .label_font(("sans-serif", 14))
            .background_style(WHITE)
            .border_style(BLACK)
            .draw()?;
        area.present()?;
        Ok(())
    }
}
