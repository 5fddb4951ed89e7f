//! Moving pictures: animated PNG, which browsers play by themselves.

use super::canvas::Canvas;

/// Pictures of one size, one after the other, each shown for some milliseconds, again and again.
///
/// # Errors
/// When they cannot be encoded.
pub(crate) fn film(pictures: &[Canvas], milliseconds: u16) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let Some(first) = pictures.first() else {
        return Ok(bytes);
    };
    let mut encoder = png::Encoder::new(&mut bytes, first.width as u32, first.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    encoder.set_animated(pictures.len() as u32, 0)?;
    encoder.set_frame_delay(milliseconds, 1000)?;
    let mut writer = encoder.write_header()?;
    for picture in pictures {
        writer.write_image_data(&picture.rgb())?;
    }
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_film_has_as_many_pictures_as_it_was_given() {
        let bytes = film(&[Canvas::new(5, 4), Canvas::new(5, 4)], 100).unwrap();
        let decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        let reader = decoder.read_info().unwrap();
        let frames = reader.info().animation_control().map(|a| a.num_frames);
        assert_eq!(frames, Some(2));
    }
}
